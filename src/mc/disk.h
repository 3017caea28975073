// Points of the unit disk.
#pragma once
#include "mc/density.h"

namespace montelux {

// Uniform on the unit disk by rings: r = sqrt(u.x), azimuth 2 pi u.y.
template <class F>
MONTELUX_INLINE Vec2<F> sample_disk_polar(Vec2<F> u) {
  F r = sqrt(u.x);
  SinCos<F> azimuth = sin_cos_two_pi(u.y);
  return {r * azimuth.cos, r * azimuth.sin};
}
template <class F>
MONTELUX_INLINE Vec2<F> invert_disk_polar(Vec2<F> p) {
  F turn = atan2(p.y, p.x) * inv_two_pi;
  turn = select(turn < F(0.0f), turn + 1.0f, turn);
  return {min(p.x * p.x + p.y * p.y, F(one_minus_epsilon)), min(turn, F(one_minus_epsilon))};
}

// A point by its distance from the centre (negative: on the opposite side) and its azimuth in turns, from
// 7/8 to 11/8.
template <class F>
struct PolarPlace {
  F r, turns;
};

// Rings of the square about its centre -> rings of the disk: r^2 and the azimuth of the place are uniform and
// independent, and neighbours in the square stay neighbours (Shirley and Chiu 1997).
template <class F>
MONTELUX_INLINE PolarPlace<F> concentric_place(Vec2<F> u) {
  F a = 2.0f * u.x - 1.0f, b = 2.0f * u.y - 1.0f;
  Mask<F> wide = abs(a) > abs(b);
  F r = select(wide, a, b);
  F ratio = select(wide, b, a) / select(r == F(0.0f), F(1.0f), r);
  // Azimuth in turns: an eighth of a turn for the ratio 1, measured from the x axis or from the y axis.
  return {r, select(wide, 0.125f * ratio, F(0.25f) - 0.125f * ratio) + 1.0f};
}

// Uniform on the unit disk.
template <class F>
MONTELUX_INLINE Vec2<F> sample_disk_concentric(Vec2<F> u) {
  const PolarPlace<F> place = concentric_place(u);
  SinCos<F> azimuth = sin_cos_two_pi(place.turns);
  return {place.r * azimuth.cos, place.r * azimuth.sin};
}
template <class F>
MONTELUX_INLINE Vec2<F> invert_disk_concentric(Vec2<F> p) {
  F r = min(sqrt(p.x * p.x + p.y * p.y), F(1.0f));
  Mask<F> wide = abs(p.x) > abs(p.y);
  F along = copysign(r, select(wide, p.x, p.y));
  // The angle from the nearer axis, over an eighth of a turn.
  F across =
      along * atan2(select(wide, p.y, p.x) * copysign(F(1.0f), along), abs(select(wide, p.x, p.y))) * (4.0f * inv_pi);
  F a = select(wide, along, across), b = select(wide, across, along);
  return {clamp(0.5f * (a + 1.0f), 0.0f, one_minus_epsilon), clamp(0.5f * (b + 1.0f), 0.0f, one_minus_epsilon)};
}

// Per unit area of the disk of radius 1.
template <class F>
MONTELUX_INLINE Density<Area, F> disk_density(Vec2<F> p) {
  return {select(p.x * p.x + p.y * p.y <= F(1.0f), F(inv_pi), F(0.0f))};
}

}  // namespace montelux
