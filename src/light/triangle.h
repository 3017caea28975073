// A triangle that emits.
#pragma once
#include "light/surface.h"
#include "mc/spherical_triangle.h"
#include "mc/triangle.h"

namespace montelux {

// Sampled uniformly in solid angle (Arvo 1995), or in area if it appears very small or very large.
template <class F>
struct TriangleEmitter {
  enum Slot {
    corner = light_slot::shape,
    edge1 = corner + 3,
    edge2 = edge1 + 3,
    normal = edge2 + 3,
    area = normal + 3,
    uv0,
    uv1 = uv0 + 2,
    uv2 = uv1 + 2,
    end = uv2 + 2
  };
  static_assert(
      fill_light_row(end, {{corner, 3}, {edge1, 3}, {edge2, 3}, {normal, 3}, {area, 1}, {uv0, 2}, {uv1, 2}, {uv2, 2}}));
  LightRows<F> rows;
  Vec3<F> p0, e1, e2, n;

  explicit MONTELUX_INLINE TriangleEmitter(const LightRows<F>& r)
      : rows(r), p0(r.vec3(corner)), e1(r.vec3(edge1)), e2(r.vec3(edge2)), n(r.vec3(normal)) {}

  MONTELUX_INLINE EmitterPoint<F> sample(Vec3<F> from, Vec2<F> u) const {
    SphericalTriangle<F> seen = spherical(from);
    Mask<F> by_angle = is_spherical(seen.solid_angle);
    Vec2<F> b = sample_triangle(u);
    if (any(by_angle)) {
      Vec2<F> met = meet_plane(from, sample_spherical_triangle(seen, u), p0, e1, e2);
      // Rounding may lead slightly past an edge.
      met.x = clamp(met.x, 0.0f, 1.0f);
      met.y = clamp(met.y, 0.0f, F(1.0f) - met.x);
      b = select(by_angle, met, b);
    }
    Vec3<F> p = point(b);
    return {p, n, parameters(b), density_of(seen, from, p, direction_to(from, p))};
  }
  MONTELUX_INLINE EmitterPoint<F> sample_by_area(Vec3<F> from, Vec2<F> u) const { return seen_from(from, site(u)); }
  MONTELUX_INLINE EmitterSite<F> site(Vec2<F> u) const {
    Vec2<F> b = sample_triangle(u);
    return {point(b), n, parameters(b), site_density(p0)};
  }
  MONTELUX_INLINE Vec2<F> site_numbers(Vec3<F> p) const {
    const Vec2<F> b = place_in_plane(p, p0, e1, e2);
    return invert_triangle(Vec2<F>{clamp(b.x, 0.0f, 1.0f), clamp(b.y, 0.0f, F(1.0f) - clamp(b.x, 0.0f, 1.0f))});
  }
  MONTELUX_INLINE Density<Area, F> site_density(Vec3<F>) const { return {F(1.0f) / rows.number(area)}; }
  MONTELUX_INLINE Vec3<F> site_error() const { return rounding_of(abs(p0) + abs(e1) + abs(e2)); }
  MONTELUX_INLINE Density<SolidAngle, F> density(Vec3<F> from, Vec3<F> p, Vec3<F> wi) const {
    return density_of(spherical(from), from, p, wi);
  }

 private:
  MONTELUX_INLINE Vec3<F> point(Vec2<F> b) const { return p0 + e1 * b.x + e2 * b.y; }
  MONTELUX_INLINE Vec2<F> parameters(Vec2<F> b) const {
    if (!any(rows.has_image())) return {F(0.0f), F(0.0f)};
    return rows.vec2(uv0) * (F(1.0f) - b.x - b.y) + rows.vec2(uv1) * b.x + rows.vec2(uv2) * b.y;
  }
  MONTELUX_INLINE SphericalTriangle<F> spherical(Vec3<F> from) const {
    Vec3<F> a = p0 - from;
    return SphericalTriangle<F>::from_corners(a, a + e1, a + e2);
  }
  MONTELUX_INLINE Density<SolidAngle, F> density_of(const SphericalTriangle<F>& seen, Vec3<F> from, Vec3<F> p,
                                                    Vec3<F> wi) const {
    return {select(is_spherical(seen.solid_angle), spherical_triangle_density(seen).value,
                   area_density(rows.number(area), n, from, p, wi).value)};
  }
};

}  // namespace montelux
