// What emitting surfaces have in common.
#pragma once
#include "light/row.h"

namespace montelux {

// Flat surfaces are sampled by solid angle between these bounds, in steradians, and by area outside them: small
// surfaces are equivalent in both, and the spherical shapes degenerate when they fill the view.
inline constexpr float min_spherical = 1e-4f, max_spherical = 6.0f;

// The density at `from` of a point p, seen along wi, that is uniform over a plane area with unit normal n.
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> area_density(F area, Vec3<F> n, Vec3<F> from, Vec3<F> p, Vec3<F> wi) {
  return to_solid_angle(Density<Area, F>{F(1.0f) / area}, length_squared(p - from), dot(n, wi));
}

// A bound of the rounding error of a sum of a few products, by the sum of their absolute values.
template <class F>
MONTELUX_INLINE Vec3<F> rounding_of(Vec3<F> absolute_sum) {
  return absolute_sum * 0x1p-20f;
}

template <class F>
MONTELUX_INLINE Vec3<F> direction_to(Vec3<F> from, Vec3<F> p) {
  Vec3<F> d = p - from;
  return d * (F(1.0f) / sqrt(max(length_squared(d), F(1e-37f))));
}

// A site as a reference point sees it.
template <class F>
MONTELUX_INLINE EmitterPoint<F> seen_from(Vec3<F> from, const EmitterSite<F>& s) {
  return {s.p, s.n, s.uv, to_solid_angle(s.density, length_squared(s.p - from), dot(s.n, direction_to(from, s.p)))};
}

// The place of the point p of a plane, in fractions of two edges from a corner.
template <class F>
MONTELUX_INLINE Vec2<F> place_in_plane(Vec3<F> p, Vec3<F> corner, Vec3<F> e1, Vec3<F> e2) {
  const Vec3<F> s = p - corner, axis = cross(e1, e2);
  const F inverse = F(1.0f) / dot(axis, axis);
  return {dot(cross(s, e2), axis) * inverse, dot(cross(e1, s), axis) * inverse};
}

// The intersection of the line from `from` along w with the plane of a corner and two edges, in fractions of the edges:
// Cramer's rule.
template <class F>
MONTELUX_INLINE Vec2<F> meet_plane(Vec3<F> from, Vec3<F> w, Vec3<F> corner, Vec3<F> e1, Vec3<F> e2) {
  Vec3<F> s = from - corner, h = cross(w, e2);
  F inverse = F(1.0f) / dot(e1, h);
  return {dot(s, h) * inverse, dot(w, cross(s, e1)) * inverse};
}

// Interpolates between four values at the corners 00, 10, 01, 11 of the unit square.
template <class F>
MONTELUX_INLINE Vec2<F> bilinear(Vec2<F> v00, Vec2<F> v10, Vec2<F> v01, Vec2<F> v11, Vec2<F> at) {
  F x = F(1.0f) - at.x, y = F(1.0f) - at.y;
  return (v00 * x + v10 * at.x) * y + (v01 * x + v11 * at.x) * at.y;
}

// Whether a ray along wi hits a side that emits, where the surface's normal is n.
template <class F>
MONTELUX_INLINE Mask<F> meets_lit_side(const LightRows<F>& rows, Vec3<F> n, Vec3<F> wi) {
  Mask<F> front = dot(n, wi) < F(0.0f), both = rows.flag(light_two_sided);
  return front | both;
}

// Which lanes of a flat surface are sampled by solid angle.
template <class F>
MONTELUX_INLINE Mask<F> is_spherical(F solid_angle) {
  return (solid_angle > F(min_spherical)) & (solid_angle < F(max_spherical));
}

}  // namespace montelux
