#include "mc/tail.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace montelux {

void LargestTerms::add(double magnitude) {
  if (heap_.size() < capacity) {
    heap_.push_back(magnitude);
    if (heap_.size() == capacity) std::make_heap(heap_.begin(), heap_.end(), std::greater<>());
  } else if (magnitude > heap_.front()) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    heap_.back() = magnitude;
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
  }
}

void LargestTerms::add(std::span<const double> terms) {
  for (double x : terms) {
    const double magnitude = std::abs(x);
    if (heap_.size() < capacity || magnitude > heap_.front()) add(magnitude);
  }
}

void LargestTerms::merge(const LargestTerms& other) {
  for (double magnitude : other.heap_) add(magnitude);
}

std::vector<double> LargestTerms::sorted() const {
  std::vector<double> result = heap_;
  std::sort(result.begin(), result.end(), std::greater<>());
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
