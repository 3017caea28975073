// Sums of numbers without rounding, so that their order does not matter.
#pragma once
#include <array>
#include <cstdint>

#include "math/lanes.h"

namespace montelux {

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

// A whole number of units of 2^-62: every number that is added is truncated to that grid, and nothing is rounded after
// that. Sums are associative and commutative, and the sum of the parts of a partition is the sum of the whole, bit for
// bit (Kulisch and Miranker 1986, sec. 2, with a finite range). The range holds up to 2^24 numbers below `largest` in
// absolute value.
class ExactSum {
 public:
  static constexpr float largest = 0x1p40f;
  ExactSum() = default;
  explicit ExactSum(double x) { add(x); }
  // The whole part and the fraction fit 64 bits each, and their difference is exact.
  void add(double x) {
    const auto whole = std::int64_t(x);
    units_ += (Int128(whole) << 62) + std::int64_t((x - double(whole)) * 0x1p62);
  }
  ExactSum& operator+=(const ExactSum& other) {
    units_ += other.units_;
    return *this;
  }
  ExactSum& operator-=(const ExactSum& other) {
    units_ -= other.units_;
    return *this;
  }
  bool operator==(const ExactSum&) const = default;
  // The nearest double.
  double value() const { return double(units_) * 0x1p-62; }

  Int128 units() const { return units_; }
  static ExactSum of_units(Int128 units) {
    ExactSum sum;
    sum.units_ = units;
    return sum;
  }

 private:
  Int128 units_ = 0;
};

// The same of products of two such numbers, in 256 bits: units of 2^-124.
class ExactProducts {
 public:
  using Words = std::array<std::uint64_t, 4>;  // of the number of units in two's complement, the low one first

  void add(const ExactSum& a, const ExactSum& b) {
    const bool negative = (a.units() < 0) != (b.units() < 0);
    const Wide product = times(magnitude(a), magnitude(b));
    sum_ = plus(sum_, negative ? minus(product) : product);
  }
  ExactProducts& operator+=(const ExactProducts& other) {
    sum_ = plus(sum_, other.sum_);
    return *this;
  }
  bool operator==(const ExactProducts&) const = default;

  // The sum over n pairs of the product of their deviations from their means, from the sums of either number. What is
  // subtracted is exact, so nothing cancels: it is 0 where one of the numbers is constant.
  double co_moment(std::uint32_t n, const ExactSum& a, const ExactSum& b) const {
    if (n == 0) return 0;
    const bool negative = (a.units() < 0) != (b.units() < 0);
    const Wide all = times(sum_, n), product = times(magnitude(a), magnitude(b));
    Wide rest = plus(all, negative ? product : minus(product));
    const bool below = rest.high >> 127 != 0;
    if (below) rest = minus(rest);
    const double units = double(rest.high) * 0x1p128 + double(rest.low);
    return (below ? -units : units) * 0x1p-124 / double(n);
  }

  Words words() const {
    return {std::uint64_t(sum_.low), std::uint64_t(sum_.low >> 64), std::uint64_t(sum_.high),
            std::uint64_t(sum_.high >> 64)};
  }
  static ExactProducts of_words(const Words& w) {
    ExactProducts sum;
    sum.sum_ = {UInt128(w[1]) << 64 | w[0], UInt128(w[3]) << 64 | w[2]};
    return sum;
  }

 private:
  // Two's complement.
  struct Wide {
    UInt128 low = 0, high = 0;
    bool operator==(const Wide&) const = default;
  };
  static UInt128 magnitude(const ExactSum& x) { return x.units() < 0 ? -UInt128(x.units()) : UInt128(x.units()); }
  static Wide plus(const Wide& a, const Wide& b) {
    const UInt128 low = a.low + b.low;
    return {low, a.high + b.high + (low < a.low)};
  }
  static Wide minus(const Wide& a) { return {-a.low, ~a.high + (a.low == 0)}; }
  // Of magnitudes below 2^127.
  static Wide times(UInt128 a, UInt128 b) {
    const std::uint64_t a0 = std::uint64_t(a), a1 = std::uint64_t(a >> 64), b0 = std::uint64_t(b),
                        b1 = std::uint64_t(b >> 64);
    const UInt128 outer = UInt128(a0) * b0, middle = UInt128(a0) * b1 + UInt128(a1) * b0;
    const UInt128 low = outer + (middle << 64);
    return {low, UInt128(a1) * b1 + (middle >> 64) + (low < outer)};
  }
  static Wide times(const Wide& a, std::uint32_t n) {
    const UInt128 first = (a.low & ~std::uint64_t(0)) * n, second = (a.low >> 64) * n + (first >> 64);
    return {second << 64 | std::uint64_t(first), a.high * n + (second >> 64)};
  }

  Wide sum_;
};

// The same of numbers whose sum is known to be small, in 64 bits: units of 2^-32, sums below 2^31 in absolute value.
class SmallExactSum {
 public:
  void add(double x) { units_ += std::int64_t(x * 0x1p32); }
  SmallExactSum& operator+=(const SmallExactSum& other) {
    units_ += other.units_;
    return *this;
  }
  bool operator==(const SmallExactSum&) const = default;
  double value() const { return double(units_) * 0x1p-32; }

  std::int64_t units() const { return units_; }
  static SmallExactSum of_units(std::int64_t units) {
    SmallExactSum sum;
    sum.units_ = units;
    return sum;
  }

 private:
  std::int64_t units_ = 0;
};

}  // namespace montelux
