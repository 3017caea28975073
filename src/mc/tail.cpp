#include "mc/tail.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "math/special.h"

namespace montelux {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

// The mean excess of the logarithms over that of the last term, and the mean square of the excess.
struct LogExcess {
  double mean = 0, square = 0;
};
LogExcess log_excess(std::span<const double> largest) {
  LogExcess e;
  const double n = double(largest.size() - 1);
  for (double x : largest) {
    const double excess = std::log(x / largest.back());
    e.mean += excess / n, e.square += excess * excess / n;
  }
  return e;
}

}  // namespace

void LargestTerms::drop_least() {
  const auto last = kept_.begin() + std::ptrdiff_t(capacity_) - 1;
  std::nth_element(kept_.begin(), last, kept_.end(), std::greater<>());
  kept_.resize(capacity_);
  threshold_ = kept_.back();
}

void LargestTerms::add(double magnitude) {
  if (!(magnitude > threshold_)) return;
  kept_.push_back(magnitude);
  if (kept_.size() == 2 * capacity_) drop_least();
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

double LargestTerms::max() const { return kept_.empty() ? 0 : *std::max_element(kept_.begin(), kept_.end()); }

std::vector<double> LargestTerms::sorted() const {
  std::vector<double> result = kept_;
  std::sort(result.begin(), result.end(), std::greater<>());
  result.resize(std::min(result.size(), capacity_));
  return result;
}

LargestTerms LargestTerms::from(std::span<const double> magnitudes, std::size_t capacity) {
  LargestTerms result(capacity);
  for (double x : magnitudes) result.add(x);
  return result;
}

double hill_index(std::span<const double> largest) {
  if (largest.size() < 10 || !(largest.back() > 0)) return none;
  const LogExcess e = log_excess(largest);
  return e.mean > 0 ? 1 / e.mean : none;
}

double TailFit::lower_bound(double level) const {
  if (terms == 0) return none;
  return index / (1 + special::normal_quantile(1 - level) / std::sqrt(double(terms)));
}

TailFit fit_tail(std::span<const double> largest, std::uint64_t count) {
  constexpr std::size_t fewest = 32;
  auto terms = std::size_t(std::min(double(largest.size()) - 1, std::sqrt(double(count))));
  if (largest.size() < 2) return {none};
  for (; terms >= fewest; terms /= 2) {
    const std::span<const double> top = largest.first(terms + 1);
    if (!(top.back() > 0)) continue;
    const LogExcess e = log_excess(top);
    if (!(e.mean > 0)) return {none};
    // For a power law the logarithms are exponential: the mean square is twice the square of the mean, and the ratio
    // has the standard deviation 2 / sqrt(terms).
    const bool lighter = e.square / (e.mean * e.mean) < 2 - 4 / std::sqrt(double(terms));
    if (!lighter) return {1 / e.mean, terms};
  }
  return {none};
}

}  // namespace montelux
