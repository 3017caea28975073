// An affine map in every lane: three rows of four numbers, laid out like Transform::rows.
#pragma once
#include "math/functions.h"

namespace montelux {

template <class F>
struct Affine {
  F m[12];

  MONTELUX_INLINE Vec3<F> direction(const Vec3<F>& d) const {
    return {m[0] * d.x + m[1] * d.y + m[2] * d.z, m[4] * d.x + m[5] * d.y + m[6] * d.z,
            m[8] * d.x + m[9] * d.y + m[10] * d.z};
  }
  MONTELUX_INLINE Vec3<F> offset() const { return {m[3], m[7], m[11]}; }
  MONTELUX_INLINE Vec3<F> point(const Vec3<F>& p) const { return direction(p) + offset(); }
  // Multiplies by the transposed matrix: maps normals if this is the inverse of the map of the points.
  MONTELUX_INLINE Vec3<F> transposed(const Vec3<F>& n) const {
    return {m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z,
            m[2] * n.x + m[6] * n.y + m[10] * n.z};
  }
  // Multiplies by the inverse transpose up to a positive factor: the cofactor matrix with the sign of the determinant.
  MONTELUX_INLINE Vec3<F> normal(const Vec3<F>& n) const {
    const Vec3<F> x{m[0], m[4], m[8]}, y{m[1], m[5], m[9]}, z{m[2], m[6], m[10]};
    const Vec3<F> yz = cross(y, z);
    return (yz * n.x + cross(z, x) * n.y + cross(x, y) * n.z) * copysign(F(1.0f), dot(x, yz));
  }
  // The point that point() maps to p, by Cramer's rule; the linear part must not be singular.
  MONTELUX_INLINE Vec3<F> preimage(const Vec3<F>& p) const {
    const Vec3<F> x{m[0], m[4], m[8]}, y{m[1], m[5], m[9]}, z{m[2], m[6], m[10]}, q = p - offset();
    const Vec3<F> yz = cross(y, z);
    return Vec3<F>{dot(q, yz), dot(q, cross(z, x)), dot(q, cross(x, y))} / dot(x, yz);
  }
  // How much volumes grow: the determinant's absolute value.
  MONTELUX_INLINE F volume() const {
    return abs(dot(Vec3<F>{m[0], m[4], m[8]}, cross(Vec3<F>{m[1], m[5], m[9]}, Vec3<F>{m[2], m[6], m[10]})));
  }
  // Multiplies by the absolute values of the linear part: for error bounds.
  MONTELUX_INLINE Vec3<F> absolute(const Vec3<F>& d) const {
    return {abs(m[0]) * d.x + abs(m[1]) * d.y + abs(m[2]) * d.z, abs(m[4]) * d.x + abs(m[5]) * d.y + abs(m[6]) * d.z,
            abs(m[8]) * d.x + abs(m[9]) * d.y + abs(m[10]) * d.z};
  }
};

// Interpolates entry by entry; exact at t = 0 and 1.
template <class F>
MONTELUX_INLINE Affine<F> lerp(F t, const Affine<F>& a, const Affine<F>& b) {
  Affine<F> r;
  for (int i = 0; i < 12; ++i) r.m[i] = a.m[i] * (F(1.0f) - t) + b.m[i] * t;
  return r;
}

}  // namespace montelux
