#include "mc/tail.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace montelux {

void LargestTerms::drop_least() {
  std::nth_element(kept_.begin(), kept_.begin() + capacity - 1, kept_.end(), std::greater<>());
  kept_.resize(capacity);
  threshold_ = kept_.back();
}

void LargestTerms::add(double magnitude) {
  if (!(magnitude > threshold_)) return;
  if (kept_.empty()) kept_.reserve(2 * capacity);
  kept_.push_back(magnitude);
  if (kept_.size() == 2 * capacity) drop_least();
}

void LargestTerms::add(std::span<const double> terms) {
  constexpr std::size_t width = 16;
  std::size_t i = 0;
  for (; i + width <= terms.size(); i += width) {
    bool some = false;
    for (std::size_t k = 0; k < width; ++k) some |= std::abs(terms[i + k]) > threshold_;
    if (!some) continue;
    for (std::size_t k = 0; k < width; ++k) add(std::abs(terms[i + k]));
  }
  for (; i < terms.size(); ++i) add(std::abs(terms[i]));
}

void LargestTerms::merge(const LargestTerms& other) {
  for (double magnitude : other.kept_) add(magnitude);
}

std::vector<double> LargestTerms::sorted() const {
  std::vector<double> result = kept_;
  std::sort(result.begin(), result.end(), std::greater<>());
  result.resize(std::min(result.size(), capacity));
  return result;
}

LargestTerms LargestTerms::from(std::span<const double> magnitudes) {
  LargestTerms result;
  for (double x : magnitudes) result.add(x);
  return result;
}

double hill_index(std::span<const double> largest) {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (largest.size() < 10 || !(largest.back() > 0)) return none;
  double sum = 0;
  for (double x : largest) sum += std::log(x / largest.back());
  return sum > 0 ? double(largest.size() - 1) / sum : none;
}

}  // namespace montelux
