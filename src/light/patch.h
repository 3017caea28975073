// Four-sided emitting surfaces: parallelograms, and bilinear patches in general.
#pragma once
#include "light/surface.h"
#include "mc/spherical_rectangle.h"

namespace montelux {

// A corner and two edges. A rectangle (the special flag) is sampled uniformly in solid angle (Urena, Fajardo and King
// 2013), or in area if it appears very small or very large; a slanted one in area.
template <class F>
struct ParallelogramEmitter {
  enum Slot {
    corner = light_slot::shape,
    edge1 = corner + 3,
    edge2 = edge1 + 3,
    normal = edge2 + 3,
    area = normal + 3,
    uv00,
    uv10 = uv00 + 2,
    uv01 = uv10 + 2,
    uv11 = uv01 + 2,
    end = uv11 + 2
  };
  static_assert(fill_light_row(
      end, {{corner, 3}, {edge1, 3}, {edge2, 3}, {normal, 3}, {area, 1}, {uv00, 2}, {uv10, 2}, {uv01, 2}, {uv11, 2}}));
  LightRows<F> rows;
  Vec3<F> p0, e1, e2, n;

  explicit MONTELUX_INLINE ParallelogramEmitter(const LightRows<F>& r)
      : rows(r), p0(r.vec3(corner)), e1(r.vec3(edge1)), e2(r.vec3(edge2)), n(r.vec3(normal)) {}

  MONTELUX_INLINE EmitterPoint<F> sample(Vec3<F> from, Vec2<F> u) const {
    SphericalRectangle<F> seen = SphericalRectangle<F>::from_edges(p0 - from, e1, e2);
    Mask<F> by_angle = is_by_angle(seen);
    Vec2<F> at = u;
    if (any(by_angle)) {
      Vec2<F> met = meet_plane(from, sample_spherical_rectangle(seen, u), p0, e1, e2);
      at = select(by_angle, Vec2<F>{clamp(met.x, 0.0f, 1.0f), clamp(met.y, 0.0f, 1.0f)}, at);
    }
    Vec3<F> p = point(at);
    return {p, n, parameters(at), density_of(seen, from, p, direction_to(from, p))};
  }
  MONTELUX_INLINE EmitterPoint<F> sample_by_area(Vec3<F> from, Vec2<F> u) const { return seen_from(from, site(u)); }
  MONTELUX_INLINE EmitterSite<F> site(Vec2<F> u) const { return {point(u), n, parameters(u), site_density(p0)}; }
  MONTELUX_INLINE Vec2<F> site_numbers(Vec3<F> p) const { return place_in_plane(p, p0, e1, e2); }
  MONTELUX_INLINE Density<Area, F> site_density(Vec3<F>) const { return {F(1.0f) / rows.number(area)}; }
  MONTELUX_INLINE Vec3<F> site_error() const { return rounding_of(abs(p0) + abs(e1) + abs(e2)); }
  MONTELUX_INLINE Density<SolidAngle, F> density(Vec3<F> from, Vec3<F> p, Vec3<F> wi) const {
    return density_of(SphericalRectangle<F>::from_edges(p0 - from, e1, e2), from, p, wi);
  }

 private:
  MONTELUX_INLINE Vec3<F> point(Vec2<F> at) const { return p0 + e1 * at.x + e2 * at.y; }
  MONTELUX_INLINE Vec2<F> parameters(Vec2<F> at) const {
    if (!any(rows.has_image())) return {F(0.0f), F(0.0f)};
    return bilinear(rows.vec2(uv00), rows.vec2(uv10), rows.vec2(uv01), rows.vec2(uv11), at);
  }
  MONTELUX_INLINE Mask<F> is_by_angle(const SphericalRectangle<F>& seen) const {
    Mask<F> right_angled = rows.flag(light_special), fit = is_spherical(seen.solid_angle);
    return right_angled & fit;
  }
  MONTELUX_INLINE Density<SolidAngle, F> density_of(const SphericalRectangle<F>& seen, Vec3<F> from, Vec3<F> p,
                                                    Vec3<F> wi) const {
    Mask<F> by_angle = is_by_angle(seen);
    return {select(by_angle, spherical_rectangle_density(seen).value,
                   area_density(rows.number(area), n, from, p, wi).value)};
  }
};

// The surface p(x, y) = p00 + x a + y b + x y c. Its parameters are sampled uniformly, so that the density per area is
// the inverse of |dp/dx x dp/dy|.
template <class F>
struct BilinearPatchEmitter {
  enum Slot {
    corner = light_slot::shape,
    along_x = corner + 3,
    along_y = along_x + 3,
    twist = along_y + 3,
    uv00 = twist + 3,
    uv10 = uv00 + 2,
    uv01 = uv10 + 2,
    uv11 = uv01 + 2,
    end = uv11 + 2
  };
  static_assert(fill_light_row(
      end, {{corner, 3}, {along_x, 3}, {along_y, 3}, {twist, 3}, {uv00, 2}, {uv10, 2}, {uv01, 2}, {uv11, 2}}));
  LightRows<F> rows;
  Vec3<F> p00, a, b, c;

  explicit MONTELUX_INLINE BilinearPatchEmitter(const LightRows<F>& r)
      : rows(r), p00(r.vec3(corner)), a(r.vec3(along_x)), b(r.vec3(along_y)), c(r.vec3(twist)) {}

  MONTELUX_INLINE EmitterPoint<F> sample(Vec3<F> from, Vec2<F> u) const { return seen_from(from, site(u)); }
  MONTELUX_INLINE EmitterSite<F> site(Vec2<F> u) const {
    Vec3<F> scaled = scaled_normal(u);
    F stretch = length(scaled);
    Vec3<F> n = scaled * (select(rows.flag(light_flipped), F(-1.0f), F(1.0f)) / max(stretch, F(1e-37f)));
    Vec2<F> uv = u;
    if (any(rows.has_image())) uv = bilinear(rows.vec2(uv00), rows.vec2(uv10), rows.vec2(uv01), rows.vec2(uv11), u);
    return {point(u), n, uv, {F(1.0f) / stretch}};
  }
  MONTELUX_INLINE Vec2<F> site_numbers(Vec3<F> p) const { return parameters(p); }
  MONTELUX_INLINE Density<Area, F> site_density(Vec3<F> p) const {
    return {F(1.0f) / length(scaled_normal(parameters(p)))};
  }
  MONTELUX_INLINE Vec3<F> site_error() const { return rounding_of(abs(p00) + abs(a) + abs(b) + abs(c)); }
  MONTELUX_INLINE Density<SolidAngle, F> density(Vec3<F> from, Vec3<F> p, Vec3<F> wi) const {
    Vec3<F> scaled = scaled_normal(parameters(p));
    F stretch = length(scaled);
    return area_density(stretch, scaled * (F(1.0f) / max(stretch, F(1e-37f))), from, p, wi);
  }

 private:
  MONTELUX_INLINE Vec3<F> point(Vec2<F> at) const { return p00 + a * at.x + (b + c * at.x) * at.y; }
  MONTELUX_INLINE Vec3<F> scaled_normal(Vec2<F> at) const { return cross(a + c * at.y, b + c * at.x); }

  // The parameters of a point of the patch: (p - p00 - x a) is parallel to (b + x c), a quadratic equation in x along
  // any axis; the root that yields p is the right one.
  MONTELUX_INLINE Vec2<F> parameters(Vec3<F> p) const {
    Vec3<F> q = p - p00, axis = scaled_normal({F(0.5f), F(0.5f)});
    F k2 = F(0.0f) - dot(axis, cross(a, c)), k1 = dot(axis, cross(q, c) - cross(a, b)), k0 = dot(axis, cross(q, b));
    F t = -0.5f * (k1 + copysign(safe_sqrt(k1 * k1 - 4.0f * k2 * k0), k1));
    Vec2<F> near = with_x(q, k0 / t), far = with_x(q, t / k2);
    F near_error = length_squared(point(near) - p), far_error = length_squared(point(far) - p);
    return select(far_error < near_error, far, near);
  }
  MONTELUX_INLINE Vec2<F> with_x(Vec3<F> q, F x) const {
    x = clamp(x, 0.0f, 1.0f);
    Vec3<F> side = b + c * x;
    return {x, clamp(dot(q - a * x, side) / max(length_squared(side), F(1e-37f)), 0.0f, 1.0f)};
  }
};

}  // namespace montelux
