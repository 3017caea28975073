// Round emitting surfaces: disks, spheres and cylinders, and parts of them.
#pragma once
#include "light/surface.h"
#include "mc/hemisphere.h"

namespace montelux {

// An ellipse around a centre, given by its two half axes, or a ring or sector of it. Sampled in area.
template <class F>
struct DiskEmitter {
  enum Slot {
    centre = light_slot::shape,
    axis1 = centre + 3,
    axis2 = axis1 + 3,
    normal = axis2 + 3,
    area = normal + 3,
    inner,
    turn,
    end
  };
  static_assert(fill_light_row(end,
                               {{centre, 3}, {axis1, 3}, {axis2, 3}, {normal, 3}, {area, 1}, {inner, 1}, {turn, 1}}));
  LightRows<F> rows;
  Vec3<F> n;

  explicit MONTELUX_INLINE DiskEmitter(const LightRows<F>& r) : rows(r), n(r.vec3(normal)) {}

  MONTELUX_INLINE EmitterPoint<F> sample(Vec3<F> from, Vec2<F> u) const { return seen_from(from, site(u)); }
  MONTELUX_INLINE EmitterSite<F> site(Vec2<F> u) const {
    F hole = rows.number(inner);
    F r = sqrt(lerp(u.x, hole * hole, F(1.0f)));
    SinCos<F> angle = sin_cos_two_pi(u.y * rows.number(turn));
    Vec3<F> p = rows.vec3(centre) + rows.vec3(axis1) * (r * angle.cos) + rows.vec3(axis2) * (r * angle.sin);
    Vec2<F> uv{u.y, (F(1.0f) - r) / max(F(1.0f) - hole, F(1e-6f))};
    return {p, n, uv, site_density(p)};
  }
  MONTELUX_INLINE Vec2<F> site_numbers(Vec3<F> p) const {
    const Vec2<F> at = place_in_plane(p, rows.vec3(centre), rows.vec3(axis1), rows.vec3(axis2));
    const F hole = rows.number(inner) * rows.number(inner);
    return {(at.x * at.x + at.y * at.y - hole) / (F(1.0f) - hole),
            azimuth_fraction(Vec3<F>{at.x, at.y, F(0.0f)}) / rows.number(turn)};
  }
  MONTELUX_INLINE Density<Area, F> site_density(Vec3<F>) const { return {F(1.0f) / rows.number(area)}; }
  MONTELUX_INLINE Vec3<F> site_error() const {
    return rounding_of(abs(rows.vec3(centre)) + abs(rows.vec3(axis1)) + abs(rows.vec3(axis2)));
  }
  MONTELUX_INLINE Density<SolidAngle, F> density(Vec3<F> from, Vec3<F> p, Vec3<F> wi) const {
    return area_density(rows.number(area), n, from, p, wi);
  }
};

// Slots of spheres and cylinders, in the shape's own space unless stated.
enum QuadricSlot {
  quadric_centre = light_slot::shape,         // in the world
  quadric_world_radius = quadric_centre + 3,  // in the world; whole spheres only
  quadric_radius,
  quadric_low,  // minimum and maximum z
  quadric_high,
  quadric_turn,  // the existing fraction of a full turn
  quadric_area,
  quadric_volume_scale,  // |determinant| of the transform
  quadric_end
};
static_assert(fill_light_row(quadric_end, {{quadric_centre, 3},
                                           {quadric_world_radius, 1},
                                           {quadric_radius, 1},
                                           {quadric_low, 1},
                                           {quadric_high, 1},
                                           {quadric_turn, 1},
                                           {quadric_area, 1},
                                           {quadric_volume_scale, 1}}));

// A part of a sphere or cylinder about z, under any affine map: sampled uniformly in area before the map.
template <class F, bool is_sphere>
struct QuadricEmitter {
  LightRows<F> rows;

  explicit MONTELUX_INLINE QuadricEmitter(const LightRows<F>& r) : rows(r) {}

  MONTELUX_INLINE EmitterPoint<F> sample(Vec3<F> from, Vec2<F> u) const { return seen_from(from, site(u)); }
  MONTELUX_INLINE EmitterSite<F> site(Vec2<F> u) const {
    F radius = rows.number(quadric_radius), low = rows.number(quadric_low), high = rows.number(quadric_high);
    F z = lerp(u.x, low, high);
    F r = radius;
    if constexpr (is_sphere) r = safe_sqrt((radius - z) * (radius + z));
    SinCos<F> angle = sin_cos_two_pi(u.y * rows.number(quadric_turn));
    Vec3<F> own{r * angle.cos, r * angle.sin, z};
    return at(rows.transform().point_to_world(own), own);
  }
  MONTELUX_INLINE Vec2<F> site_numbers(Vec3<F> p) const {
    const Vec3<F> own = rows.transform().point_to_light(p);
    const F low = rows.number(quadric_low);
    return {(own.z - low) / (rows.number(quadric_high) - low), azimuth_fraction(own) / rows.number(quadric_turn)};
  }
  MONTELUX_INLINE Density<SolidAngle, F> density(Vec3<F> from, Vec3<F> p, Vec3<F> wi) const {
    const EmitterSite<F> s = at(p, rows.transform().point_to_light(p));
    return to_solid_angle(s.density, length_squared(p - from), dot(s.n, wi));
  }
  MONTELUX_INLINE Density<Area, F> site_density(Vec3<F> p) const {
    return at(p, rows.transform().point_to_light(p)).density;
  }
  MONTELUX_INLINE Vec3<F> site_error() const {
    const F reach =
        max(rows.number(quadric_radius), max(abs(rows.number(quadric_low)), abs(rows.number(quadric_high))));
    return rounding_of(rows.transform().absolute_point_to_world({reach, reach, reach}));
  }
  // The point p of the world, which is `own` in the shape's space.
  MONTELUX_INLINE EmitterSite<F> at(Vec3<F> p, Vec3<F> own) const {
    // The map scales an area by |det| |inverse transpose of its normal|.
    Vec3<F> outward = normalize(Vec3<F>{own.x, own.y, is_sphere ? own.z : F(0.0f)});
    Vec3<F> mapped = rows.transform().normal_to_world(outward);
    F mapped_length = length(mapped);
    F area = rows.number(quadric_area) * rows.number(quadric_volume_scale) * mapped_length;
    Vec3<F> n = mapped * (select(rows.flag(light_flipped), F(-1.0f), F(1.0f)) / mapped_length);
    return {p, n, parameters(own), {F(1.0f) / area}};
  }
  // Azimuth and height (of spheres: polar angle from the lower end) as fractions of the existing part.
  MONTELUX_INLINE Vec2<F> parameters(Vec3<F> own) const {
    F azimuth = azimuth_fraction(own) / rows.number(quadric_turn);
    F low = rows.number(quadric_low), high = rows.number(quadric_high);
    if constexpr (is_sphere) {
      F inverse = F(1.0f) / rows.number(quadric_radius);
      F first = acos(low * inverse), last = acos(high * inverse);
      return {azimuth, (acos(own.z * inverse) - first) / (last - first)};
    } else {
      return {azimuth, (own.z - low) / (high - low)};
    }
  }
};
template <class F>
using CylinderEmitter = QuadricEmitter<F, false>;

// A sphere. A whole one that is still a sphere in the world (the special flag) is sampled from outside uniformly in the
// solid angle of its visible cap, otherwise like any quadric.
template <class F>
struct SphereEmitter {
  QuadricEmitter<F, true> part;

  explicit MONTELUX_INLINE SphereEmitter(const LightRows<F>& r) : part(r) {}

  MONTELUX_INLINE EmitterPoint<F> sample(Vec3<F> from, Vec2<F> u) const {
    Cap cap = cap_from(from);
    EmitterPoint<F> result{};
    if (!all(cap.visible)) result = part.sample(from, u);
    if (!any(cap.visible)) return result;

    // The angle at the centre of the point where a direction of the cone first meets the sphere (Pharr, Jakob and
    // Humphreys 2023, sec. 6.2.4).
    Vec3<F> w = sample_cone(cap.one_minus_cos, u);
    F sin2 = w.x * w.x + w.y * w.y;
    F cos_a = clamp(sin2 / cap.sin + w.z * safe_sqrt(F(1.0f) - sin2 / (cap.sin * cap.sin)), -1.0f, 1.0f);
    F around = safe_sqrt(F(1.0f) - cos_a * cos_a) / max(sqrt(sin2), F(1e-30f));
    Vec3<F> outward = LocalFrame<F>::from_normal(cap.axis).to_world({w.x * around, w.y * around, -cos_a});
    const LightRows<F>& rows = part.rows;
    Vec3<F> p = rows.vec3(quadric_centre) + outward * rows.number(quadric_world_radius);
    Vec3<F> n = outward * select(rows.flag(light_flipped), F(-1.0f), F(1.0f));
    Vec2<F> uv = result.uv;
    if (any(rows.has_image())) uv = select(cap.visible, part.parameters(rows.transform().point_to_light(p)), uv);
    return {select(cap.visible, p, result.p),
            select(cap.visible, n, result.n),
            uv,
            {select(cap.visible, cone_density(cap.one_minus_cos).value, result.density.value)}};
  }
  MONTELUX_INLINE EmitterPoint<F> sample_by_area(Vec3<F> from, Vec2<F> u) const { return part.sample(from, u); }
  MONTELUX_INLINE EmitterSite<F> site(Vec2<F> u) const { return part.site(u); }
  MONTELUX_INLINE Vec2<F> site_numbers(Vec3<F> p) const { return part.site_numbers(p); }
  MONTELUX_INLINE Density<Area, F> site_density(Vec3<F> p) const { return part.site_density(p); }
  MONTELUX_INLINE Vec3<F> site_error() const { return part.site_error(); }
  MONTELUX_INLINE Density<SolidAngle, F> density(Vec3<F> from, Vec3<F> p, Vec3<F> wi) const {
    Cap cap = cap_from(from);
    F value = all(cap.visible) ? F(0.0f) : part.density(from, p, wi).value;
    return {select(cap.visible, cone_density(cap.one_minus_cos).value, value)};
  }

 private:
  // The cone of directions to the sphere.
  struct Cap {
    Vec3<F> axis;
    F sin, one_minus_cos;
    Mask<F> visible;  // the reference point is outside, and the sphere is whole and round
  };
  MONTELUX_INLINE Cap cap_from(Vec3<F> from) const {
    Vec3<F> d = part.rows.vec3(quadric_centre) - from;
    F d2 = max(length_squared(d), F(1e-37f)), r = part.rows.number(quadric_world_radius);
    F sin2 = min(r * r / d2, F(1.0f));
    Mask<F> outside = d2 > r * r * 1.0001f, whole = part.rows.flag(light_special);
    return {d * (F(1.0f) / sqrt(d2)), sqrt(sin2), sin2 / (F(1.0f) + sqrt(F(1.0f) - sin2)), Mask<F>(outside & whole)};
  }
};

}  // namespace montelux
