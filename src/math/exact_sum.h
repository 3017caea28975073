// Sums of numbers without rounding, so that their order does not matter.
#pragma once
#include "math/lanes.h"

namespace montelux {

// A whole number of units of 2^-62: every number that is added is truncated to that grid, and nothing is rounded after
// that. Sums are associative and commutative, and the sum of the parts of a partition is the sum of the whole, bit for
// bit (Kulisch and Miranker 1986, sec. 2, with a finite range). The range holds up to 2^24 numbers below `largest` in
// absolute value.
class ExactSum {
 public:
  static constexpr float largest = 0x1p40f;
  void add(float x) { units_ += Units(double(x) * 0x1p62); }
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

 private:
  __extension__ using Units = __int128;
  Units units_ = 0;
};

}  // namespace montelux
