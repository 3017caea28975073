// Directions about +z with density proportional to cos^n of the angle to it, n >= 0 (Lafortune and Willems 1994, eq.
// 7).
#pragma once
#include "mc/hemisphere.h"

namespace montelux {

template <class F>
MONTELUX_INLINE Vec3<F> sample_phong_lobe(F n, Vec2<F> u) {
  // 1 - u.x maps small u to the centre of the lobe.
  F cos = pow(F(1.0f) - u.x, F(1.0f) / (n + 1.0f));
  return direction_at(cos, u.y);
}
// (n + 1) / 2 pi cos^n; zero below the plane.
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> phong_lobe_density(F n, F cos) {
  return {select(cos >= F(0.0f), (n + 1.0f) * inv_two_pi * pow(cos, n), F(0.0f))};
}
template <class F>
MONTELUX_INLINE Vec2<F> invert_phong_lobe(F n, Vec3<F> w) {
  return {clamp(F(1.0f) - pow(max(w.z, F(0.0f)), n + 1.0f), 0.0f, one_minus_epsilon), azimuth_fraction(w)};
}

}  // namespace montelux
