// Sums without rounding that many threads add to at once.
#pragma once
#include <atomic>
#include <cstdint>

#include "math/exact_sum.h"

namespace montelux {

// An ExactSum in two words. A carry goes from the low word to the high one with the addition that causes it: every one
// is counted once, in whatever order, so that the sum is exact as soon as nobody adds any more.
class SharedExactSum {
 public:
  void add(float x) {
    const Int128 units = ExactSum(double(x)).units();
    const auto low = std::uint64_t(units);
    const std::uint64_t before = low_.fetch_add(low, std::memory_order_relaxed);
    const std::uint64_t high = std::uint64_t(units >> 64) + (before + low < before ? 1u : 0u);
    if (high != 0) high_.fetch_add(high, std::memory_order_relaxed);
  }
  // The sum so far. Only while nobody adds.
  ExactSum sum() const {
    const UInt128 low = low_.load(std::memory_order_relaxed), high = high_.load(std::memory_order_relaxed);
    return ExactSum::of_units(Int128(high << 64 | low));
  }
  // The same; it begins at zero again.
  ExactSum take() {
    const UInt128 low = low_.exchange(0, std::memory_order_relaxed),
                  high = high_.exchange(0, std::memory_order_relaxed);
    return ExactSum::of_units(Int128(high << 64 | low));
  }

 private:
  std::atomic<std::uint64_t> low_{0}, high_{0};
};

}  // namespace montelux
