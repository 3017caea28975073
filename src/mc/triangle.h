// Points of a triangle, uniform in area, as barycentric coordinates.
#pragma once
#include "mc/density.h"

namespace montelux {

// Weights of the corners 1 and 2; that of corner 0 is 1 - x - y. The first coordinate by its marginal density, the
// second given the first (Turk 1990).
template <class F>
MONTELUX_INLINE Vec2<F> sample_triangle(Vec2<F> u) {
  F root = sqrt(u.x);
  return {F(1.0f) - root, u.y * root};
}
template <class F>
MONTELUX_INLINE Density<Area, F> triangle_density(F area) {
  return {F(1.0f) / area};
}
template <class F>
MONTELUX_INLINE Vec2<F> invert_triangle(Vec2<F> barycentric) {
  F root = F(1.0f) - barycentric.x;
  return {clamp(root * root, 0.0f, one_minus_epsilon),
          clamp(barycentric.y / max(root, F(1e-30f)), 0.0f, one_minus_epsilon)};
}

}  // namespace montelux
