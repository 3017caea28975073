// Straight-line densities: the tent on [-1, 1] and the linear density on [0, 1).
#pragma once
#include "mc/density.h"

namespace montelux {

// Density 1 - |x|.
template <class F>
MONTELUX_INLINE F sample_tent(F u) {
  Mask<F> left = u < F(0.5f);
  F rest = select(left, 2.0f * u, 2.0f * (F(1.0f) - u));
  F x = F(1.0f) - sqrt(rest);
  return select(left, -x, x);
}
template <class F>
MONTELUX_INLINE Density<Length, F> tent_density(F x) {
  return {max(F(1.0f) - abs(x), F(0.0f))};
}
template <class F>
MONTELUX_INLINE F invert_tent(F x) {
  F rest = 0.5f * square(F(1.0f) - abs(x));
  return min(select(x < F(0.0f), rest, F(1.0f) - rest), F(one_minus_epsilon));
}

// Density proportional to (1 - x) a + x b; a, b >= 0 and not both zero.
template <class F>
MONTELUX_INLINE F sample_linear(F a, F b, F u) {
  // The root of the quadratic distribution function in the form that avoids cancellation.
  F root = sqrt(lerp(u, a * a, b * b));
  return min(u * (a + b) / max(a + root, F(1e-30f)), F(one_minus_epsilon));
}
template <class F>
MONTELUX_INLINE Density<Length, F> linear_density(F a, F b, F x) {
  return {select((x >= F(0.0f)) & (x <= F(1.0f)), 2.0f * lerp(x, a, b) / (a + b), F(0.0f))};
}
template <class F>
MONTELUX_INLINE F invert_linear(F a, F b, F x) {
  return min(x * (2.0f * a + x * (b - a)) / (a + b), F(one_minus_epsilon));
}

}  // namespace montelux
