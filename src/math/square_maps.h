// The map between the unit square and the sphere that keeps areas up to a constant.
#pragma once
#include "math/functions.h"

namespace montelux {

// The unit sphere from (u, v) in [0, 1]^2: the centre is +z, the corners -z, the octahedron's diagonals the equator
// (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD"). Jacobian 4 pi.
template <class F>
MONTELUX_INLINE Vec3<F> sphere_from_square(Vec2<F> uv) {
  F u = uv.x * 2.0f - 1.0f, v = uv.y * 2.0f - 1.0f;
  F au = abs(u), av = abs(v);
  F to_equator = F(1.0f) - (au + av);
  F r = F(1.0f) - abs(to_equator);
  F phi = select(r == F(0.0f), F(1.0f), (av - au) / max(r, F(1e-30f)) + 1.0f) * (0.25f * pi);
  SinCos<F> turn = sin_cos(phi);
  F across = r * safe_sqrt(F(2.0f) - r * r);
  return {copysign(turn.cos, u) * across, copysign(turn.sin, v) * across, copysign(F(1.0f) - r * r, to_equator)};
}

// The inverse of sphere_from_square for a unit vector.
template <class F>
MONTELUX_INLINE Vec2<F> square_from_sphere(Vec3<F> w) {
  F r = safe_sqrt(F(1.0f) - abs(w.z));
  F phi = atan2(abs(w.y), abs(w.x)) * (2.0f * inv_pi);
  F v = phi * r, u = r - v;
  // The lower half is folded outward over the diagonals.
  Mask<F> below = w.z < F(0.0f);
  F fu = select(below, F(1.0f) - v, u), fv = select(below, F(1.0f) - u, v);
  return {(copysign(fu, w.x) + 1.0f) * 0.5f, (copysign(fv, w.y) + 1.0f) * 0.5f};
}

// Moves a point slightly outside the square to where the map of the sphere continues inside.
template <class F>
MONTELUX_INLINE Vec2<F> wrap_sphere_square(Vec2<F> uv) {
  auto fold = [](F inside, F& across) {
    Mask<F> out = (inside < F(0.0f)) | (inside > F(1.0f));
    across = select(out, F(1.0f) - across, across);
    return select(inside < F(0.0f), -inside, select(inside > F(1.0f), F(2.0f) - inside, inside));
  };
  uv.x = fold(uv.x, uv.y);
  uv.y = fold(uv.y, uv.x);
  return uv;
}

}  // namespace montelux
