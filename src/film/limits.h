// What a film accepts of one sample.
#pragma once
#include <algorithm>
#include <cmath>

#include "color/rgb.h"
#include "math/exact_sum.h"

namespace montelux {

// The number clamped to the bounds; 0 for NaN.
inline double within(double x, double bound) { return x >= -bound ? std::min(x, bound) : x < -bound ? -bound : 0; }

// Whether it is finite, and within the range of the sums.
inline bool is_kept(const Rgb& light) {
  for (const float x : light.c)
    if (!(std::abs(x) < ExactSum::largest)) return false;
  return true;
}

}  // namespace montelux
