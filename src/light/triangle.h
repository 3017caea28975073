// A triangle that emits.
#pragma once
#include "light/row.h"

namespace montelux {

// The density at `from` of a point p, seen along wi, that is uniform over a plane area with unit normal n.
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> area_density(F area, Vec3<F> n, Vec3<F> from, Vec3<F> p, Vec3<F> wi) {
  return to_solid_angle(Density<Area, F>{F(1.0f) / area}, length_squared(p - from), dot(n, wi));
}

// The density at `from` of the drawn point p, and the rest that a sample needs.
template <class F, class Emitter>
MONTELUX_INLINE EmitterPoint<F> emitter_point(const Emitter& emitter, Vec3<F> from, Vec3<F> p, Vec3<F> n, Vec2<F> uv) {
  Vec3<F> d = p - from;
  Vec3<F> wi = d * (F(1.0f) / sqrt(max(length_squared(d), F(1e-37f))));
  return {p, n, uv, emitter.density(from, p, wi)};
}

template <class F>
struct TriangleEmitter {
  // Slots from light_slot::shape on.
  enum Slot {
    corner = light_slot::shape,
    edge1 = corner + 3,
    edge2 = edge1 + 3,
    normal = edge2 + 3,
    area = normal + 3,
    uv0,
    uv1 = uv0 + 2,
    uv2 = uv1 + 2
  };
  Vec3<F> p0, e1, e2, n;
  F surface;
  LightRows<F> rows;

  explicit MONTELUX_INLINE TriangleEmitter(const LightRows<F>& r)
      : p0(r.vec3(corner)), e1(r.vec3(edge1)), e2(r.vec3(edge2)), n(r.vec3(normal)), surface(r.number(area)), rows(r) {}

  MONTELUX_INLINE EmitterPoint<F> sample(Vec3<F> from, Vec2<F> u) const {
    // Uniform barycentrics by folding, which keeps strata together (Heitz 2019, "A Low-Distortion Map Between Triangle
    // and Square").
    Mask<F> upper = u.x < u.y;
    F half = select(upper, u.x, u.y) * 0.5f;
    F b0 = select(upper, half, u.x - half), b1 = select(upper, u.y - half, half);
    F b2 = F(1.0f) - b0 - b1;
    Vec2<F> uv = rows.vec2(uv0) * b0 + rows.vec2(uv1) * b1 + rows.vec2(uv2) * b2;
    return emitter_point(*this, from, p0 + e1 * b1 + e2 * b2, n, uv);
  }
  MONTELUX_INLINE Density<SolidAngle, F> density(Vec3<F> from, Vec3<F> p, Vec3<F> wi) const {
    return area_density(surface, n, from, p, wi);
  }
};

}  // namespace montelux
