// Directions: the sphere, the hemisphere about +z (uniform and weighted by the cosine) and the cone about +z.
// All densities are per steradian; every map has its inverse.
#pragma once
#include "mc/disk.h"

namespace montelux {

// The azimuth of w as a fraction of a turn, in [0, 1).
template <class F>
MONTELUX_INLINE F azimuth_fraction(Vec3<F> w) {
  F turn = atan2(w.y, w.x) * inv_two_pi;
  turn = select(turn < F(0.0f), turn + 1.0f, turn);
  return clamp(turn, 0.0f, one_minus_epsilon);
}

// The direction at the height z above the plane and the azimuth in turns.
template <class F>
MONTELUX_INLINE Vec3<F> direction_at(F z, F turns) {
  F r = safe_sqrt((F(1.0f) - z) * (F(1.0f) + z));
  SinCos<F> azimuth = sin_cos_two_pi(turns);
  return {r * azimuth.cos, r * azimuth.sin, z};
}

// ---- sphere: heights are uniform (Archimedes) -----------------------------------------------------------------------

template <class F>
MONTELUX_INLINE Vec3<F> sample_sphere(Vec2<F> u) {
  return direction_at(F(1.0f) - 2.0f * u.x, u.y);
}
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> sphere_density() {
  return {F(inv_four_pi)};
}
template <class F>
MONTELUX_INLINE Vec2<F> invert_sphere(Vec3<F> w) {
  return {clamp(0.5f * (F(1.0f) - w.z), 0.0f, one_minus_epsilon), azimuth_fraction(w)};
}

// ---- hemisphere, uniform in solid angle -----------------------------------------------------------------------------

template <class F>
MONTELUX_INLINE Vec3<F> sample_hemisphere(Vec2<F> u) {
  return direction_at(F(1.0f) - u.x, u.y);
}
// `cos` is that of the angle to the pole; zero below the plane.
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> hemisphere_density(F cos) {
  return {select(cos >= F(0.0f), F(inv_two_pi), F(0.0f))};
}
template <class F>
MONTELUX_INLINE Vec2<F> invert_hemisphere(Vec3<F> w) {
  return {clamp(F(1.0f) - w.z, 0.0f, one_minus_epsilon), azimuth_fraction(w)};
}

// ---- hemisphere, uniform in projected solid angle: a point of the disk lifted (Malley) ------------------------------

template <class F>
MONTELUX_INLINE Vec3<F> sample_cosine_hemisphere(Vec2<F> u) {
  Vec2<F> p = sample_disk_concentric(u);
  return {p.x, p.y, safe_sqrt(F(1.0f) - p.x * p.x - p.y * p.y)};
}
// cos / pi; zero below the plane.
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> cosine_hemisphere_density(F cos) {
  return {max(cos, F(0.0f)) * inv_pi};
}
template <class F>
MONTELUX_INLINE Vec2<F> invert_cosine_hemisphere(Vec3<F> w) {
  return invert_disk_concentric(Vec2<F>{w.x, w.y});
}

// ---- cone about +z, uniform in solid angle --------------------------------------------------------------------------

// A cone by 1 - cos of its half angle, which keeps narrow cones exact; in (0, 2].
template <class F>
MONTELUX_INLINE Vec3<F> sample_cone(F one_minus_cos, Vec2<F> u) {
  F below = u.x * one_minus_cos;
  F r = safe_sqrt(below * (F(2.0f) - below));
  SinCos<F> azimuth = sin_cos_two_pi(u.y);
  return {r * azimuth.cos, r * azimuth.sin, F(1.0f) - below};
}
// The density inside the cone; outside it is zero, which the caller decides.
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> cone_density(F one_minus_cos) {
  return {inv_two_pi / one_minus_cos};
}
template <class F>
MONTELUX_INLINE Vec2<F> invert_cone(F one_minus_cos, Vec3<F> w) {
  // 1 - z without cancellation near the pole.
  F below = select(w.z > F(0.5f), (w.x * w.x + w.y * w.y) / (F(1.0f) + w.z), F(1.0f) - w.z);
  return {clamp(below / one_minus_cos, 0.0f, one_minus_epsilon), azimuth_fraction(w)};
}

}  // namespace montelux
