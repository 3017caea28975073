// Lights at one point: each has a position, an intensity (W / sr) towards a unit direction of the world, and a density
// of the directions in which rays leave it.
#pragma once
#include "light/images.h"
#include "light/stated.h"
#include "math/square_maps.h"
#include "mc/hemisphere.h"

namespace montelux {

// A direction in which a ray leaves a light. Without a meaning where the density is zero.
template <class F>
struct LeavingDirection {
  Vec3<F> d;
  Density<SolidAngle, F> density;
};

// The same intensity in all directions.
struct PointLightDesc {
  SpectrumValue intensity = gray_value(1);  // W/sr
  Vec3f from{0, 0, 0};
  std::optional<float> power{};  // W, to which the light is scaled; none, or not positive: as stated

  static constexpr std::string_view name = "point", meaning = "the same intensity in all directions";
  static Fields<PointLightDesc> rows();
  std::optional<LightId> add(LightAdder& adder) const;
};

// The same in all directions.
template <class F>
struct PointEmitter {
  using Stated = PointLightDesc;
  Vec3<F> p;
  Spectrum<F> emission;

  MONTELUX_INLINE PointEmitter(const LightRows<F>& r, const LightImages&)
      : p(r.vec3(light_slot::shape)), emission(r.emission()) {}
  MONTELUX_INLINE Spectrum<F> intensity(Vec3<F>, Mask<F>) const { return emission; }
  MONTELUX_INLINE LeavingDirection<F> leave(Vec2<F> u, Mask<F>) const {
    return {sample_sphere(u), sphere_density<F>()};
  }
  MONTELUX_INLINE Density<SolidAngle, F> leaving_density(Vec3<F>, Mask<F>) const { return sphere_density<F>(); }
  MONTELUX_INLINE Vec2<F> leaving_numbers(Vec3<F> d, Mask<F>) const { return invert_sphere(d); }
};

// How the intensity of a spot falls from the inner cone to its edge: by a smooth step of the cosine, or by the square
// of a linear ramp of the cosine.
enum class SpotFalloff { smooth, squared };

// A cone with a soft edge.
struct SpotLightDesc {
  SpectrumValue intensity = gray_value(1);  // W/sr
  Vec3f from{0, 0, 0}, to{0, 0, 1};
  float cone_angle = 30;       // half-angle in degrees
  float cone_delta_angle = 5;  // width of the edge in degrees, inside the cone
  SpotFalloff falloff = SpotFalloff::smooth;
  std::optional<float> power{};

  static constexpr std::string_view name = "spot", meaning = "a cone with a soft edge";
  static Fields<SpotLightDesc> rows();
  std::optional<LightId> add(LightAdder& adder) const;
};

// 0 below `low`, 1 above `high`, between them t^2 (1 + bend - bend t): a bend of 2 gives a cubic with zero end slopes,
// 0 a square. A step if low and high are equal.
template <class F>
MONTELUX_INLINE F soft_step(F x, F low, F high, F bend) {
  F t = clamp((x - low) / max(high - low, F(1e-30f)), 0.0f, 1.0f);
  return t * t * (F(1.0f) + bend - bend * t);
}

// A cone with a soft edge, by the cosines of its whole half angle and of where the edge begins.
template <class F>
struct SpotEmitter {
  using Stated = SpotLightDesc;
  enum Slot { place = light_slot::shape, axis = place + 3, cos_end = axis + 3, cos_edge, bend, end };
  static_assert(fill_light_row(end, {{place, 3}, {axis, 3}, {cos_end, 1}, {cos_edge, 1}, {bend, 1}}));
  Vec3<F> p;
  LightRows<F> rows;

  MONTELUX_INLINE SpotEmitter(const LightRows<F>& r, const LightImages&) : p(r.vec3(place)), rows(r) {}
  MONTELUX_INLINE Spectrum<F> intensity(Vec3<F> w, Mask<F>) const {
    return rows.emission() *
           soft_step(dot(rows.vec3(axis), w), rows.number(cos_end), rows.number(cos_edge), rows.number(bend));
  }
  MONTELUX_INLINE LeavingDirection<F> leave(Vec2<F> u, Mask<F>) const {
    return {about_axis().to_world(sample_cone(one_minus_cos(), u)), cone_density(one_minus_cos())};
  }
  MONTELUX_INLINE Density<SolidAngle, F> leaving_density(Vec3<F> d, Mask<F>) const {
    const Mask<F> inside = dot(rows.vec3(axis), d) >= rows.number(cos_end);
    return {select(inside, cone_density(one_minus_cos()).value, F(0.0f))};
  }
  MONTELUX_INLINE Vec2<F> leaving_numbers(Vec3<F> d, Mask<F>) const {
    return invert_cone(one_minus_cos(), about_axis().to_local(d));
  }

 private:
  MONTELUX_INLINE F one_minus_cos() const { return F(1.0f) - rows.number(cos_end); }
  MONTELUX_INLINE LocalFrame<F> about_axis() const { return LocalFrame<F>::from_normal(rows.vec3(axis)); }
};

// An intensity by direction.
struct GoniometricLightDesc {
  SpectrumValue intensity = gray_value(1);  // W/sr, times the image
  std::string file{};                       // square and equal-area; empty: constant
  std::optional<float> power{};

  static constexpr std::string_view name = "goniometric", meaning = "an intensity by direction, given by an image";
  static Fields<GoniometricLightDesc> rows();
  std::optional<LightId> add(LightAdder& adder) const;
};

// Lights whose intensity is given by an image, by direction: the images of all lights, and which of them a row uses.
template <class F>
struct ImagedLights {
  LightImages of;
  LightRows<F> rows;

  // The emission times the result of f(image, lane), in the lanes that are on; other lanes are black.
  template <class Function>
  MONTELUX_INLINE Spectrum<F> times_image(Mask<F> on, Function f) const {
    Spectrum<F> e = rows.emission(), r = gray(F(0.0f));
    Uint<F> image = rows.bits(light_slot::image);
    for_each_lane(on, [&](int k) {
      std::uint32_t number = lane(image, k);
      set_lane(r, k, number == 0 ? lane(e, k) : lane(e, k) * f(*of.images[number - 1], k));
    });
    return r;
  }
};

// A measured luminaire: the mean of the components of a square equal-area image over the sphere of directions.
template <class F>
struct GoniometricEmitter {
  using Stated = GoniometricLightDesc;
  Vec3<F> p;
  ImagedLights<F> light;

  MONTELUX_INLINE GoniometricEmitter(const LightRows<F>& r, const LightImages& images)
      : p(r.vec3(light_slot::shape)), light{images, r} {}
  MONTELUX_INLINE Spectrum<F> intensity(Vec3<F> w, Mask<F> on) const {
    Vec2<F> uv = square_from_sphere(normalize(light.rows.transform().direction_to_light(w)));
    return light.times_image(on,
                             [&](const LightImage& image, int k) { return gray(average(image.nearest(lane(uv, k)))); });
  }
  // In proportion to the image; uniform without one.
  MONTELUX_INLINE LeavingDirection<F> leave(Vec2<F> u, Mask<F> on) const {
    LeavingDirection<F> r{sample_sphere(u), sphere_density<F>()};
    const LightTransforms<F> transform = light.rows.transform();
    for_each_distribution<F>(light.rows, light.of, on, [&](const PiecewiseConstant2& table, Mask<F> same) {
      const PointSample2<F> s = table.sample(u);
      const Vec3<F> own = sphere_from_square(s.p);
      r.d = select(same, normalize(transform.direction_to_world(own)), r.d);
      r.density.value =
          select(same, s.density.value * inv_four_pi / transform.solid_angle_growth(own), r.density.value);
    });
    return r;
  }
  MONTELUX_INLINE Density<SolidAngle, F> leaving_density(Vec3<F> d, Mask<F> on) const {
    F density = sphere_density<F>().value;
    const Vec3<F> own = own_direction(d);
    const F growth = light.rows.transform().solid_angle_growth(own);
    const Vec2<F> uv = inside_square(square_from_sphere(own));
    for_each_distribution<F>(light.rows, light.of, on, [&](const PiecewiseConstant2& table, Mask<F> same) {
      density = select(same, table.density(uv).value * inv_four_pi / growth, density);
    });
    return {density};
  }
  MONTELUX_INLINE Vec2<F> leaving_numbers(Vec3<F> d, Mask<F> on) const {
    Vec2<F> u = invert_sphere(d);
    const Vec2<F> uv = inside_square(square_from_sphere(own_direction(d)));
    for_each_distribution<F>(light.rows, light.of, on, [&](const PiecewiseConstant2& table, Mask<F> same) {
      u = select(same, table.invert(uv), u);
    });
    return u;
  }

 private:
  MONTELUX_INLINE Vec3<F> own_direction(Vec3<F> d) const {
    return normalize(light.rows.transform().direction_to_light(d));
  }
};

// A slide projector along +z.
struct ProjectionLightDesc {
  std::string file{};  // the slide; it is needed
  SpectrumValue factor = gray_value(1);
  float fov = 90;  // of the shorter side, in degrees
  std::optional<float> power{};

  static constexpr std::string_view name = "projection", meaning = "a slide projector along +z";
  static Fields<ProjectionLightDesc> rows();
  std::optional<LightId> add(LightAdder& adder) const;
};

// Slots of a projection light.
enum ProjectionSlot {
  projection_place = light_slot::shape,
  projection_cotangent = projection_place + 3,
  projection_half_width,
  projection_half_height,
  projection_end
};
static_assert(fill_light_row(
    projection_end,
    {{projection_place, 3}, {projection_cotangent, 1}, {projection_half_width, 1}, {projection_half_height, 1}}));

// The plane z = 1 of a projector's own space, on which its image lies.
template <class F>
struct ProjectionPlane {
  static constexpr float near = 1e-3f;  // minimum cosine to the axis at which a point is lit
  LightRows<F> rows;
  F cotangent, half_width, half_height;

  explicit MONTELUX_INLINE ProjectionPlane(const LightRows<F>& r)
      : rows(r),
        cotangent(r.number(projection_cotangent)),
        half_width(r.number(projection_half_width)),
        half_height(r.number(projection_half_height)) {}

  // Where a unit direction of the projector's space meets the image, in [0, 1]^2 within it; own.z > 0.
  MONTELUX_INLINE Vec2<F> place(Vec3<F> own) const {
    F scale = cotangent / max(own.z, F(near));
    return {0.5f * (own.x * scale / half_width + 1.0f), 0.5f * (own.y * scale / half_height + 1.0f)};
  }
  // The inverse.
  MONTELUX_INLINE Vec3<F> direction(Vec2<F> uv) const {
    return normalize(Vec3<F>{(2.0f * uv.x - 1.0f) * half_width / cotangent,
                             (2.0f * uv.y - 1.0f) * half_height / cotangent, F(1.0f)});
  }
  // A density of the place as one of the direction in the world: dw = cos^3 dA on a plane at distance 1.
  MONTELUX_INLINE Density<SolidAngle, F> of_direction(Density<Area, F> of_place, Vec3<F> own) const {
    F area = 4.0f * half_width * half_height / (cotangent * cotangent);
    return {of_place.value / (area * own.z * own.z * own.z * rows.transform().solid_angle_growth(own))};
  }
};

// A slide projector along the light's +z: the image is on the plane z = 1, its shorter side within the field of view.
template <class F>
struct ProjectionEmitter {
  using Stated = ProjectionLightDesc;
  Vec3<F> p;
  ImagedLights<F> light;

  MONTELUX_INLINE ProjectionEmitter(const LightRows<F>& r, const LightImages& images)
      : p(r.vec3(projection_place)), light{images, r} {}
  MONTELUX_INLINE Spectrum<F> intensity(Vec3<F> w, Mask<F> on) const {
    Vec3<F> own = normalize(light.rows.transform().direction_to_light(w));
    Vec2<F> uv = ProjectionPlane<F>(light.rows).place(own);
    Mask<F> lit = (own.z >= F(ProjectionPlane<F>::near)) & (uv.x >= F(0.0f)) & (uv.x <= F(1.0f)) & (uv.y >= F(0.0f)) &
                  (uv.y <= F(1.0f));
    return light.times_image(Mask<F>(on & lit),
                             [&](const LightImage& image, int k) { return from_rgb(image.nearest(lane(uv, k))); });
  }
  // In proportion to the image.
  MONTELUX_INLINE LeavingDirection<F> leave(Vec2<F> u, Mask<F> on) const {
    LeavingDirection<F> r{sample_sphere(u), sphere_density<F>()};
    const ProjectionPlane<F> plane(light.rows);
    for_each_distribution<F>(light.rows, light.of, on, [&](const PiecewiseConstant2& table, Mask<F> same) {
      const PointSample2<F> s = table.sample(u);
      const Vec3<F> own = plane.direction(s.p);
      r.d = select(same, normalize(light.rows.transform().direction_to_world(own)), r.d);
      r.density.value = select(same, plane.of_direction(s.density, own).value, r.density.value);
    });
    return r;
  }
  MONTELUX_INLINE Density<SolidAngle, F> leaving_density(Vec3<F> d, Mask<F> on) const {
    const ProjectionPlane<F> plane(light.rows);
    const Vec3<F> own = normalize(light.rows.transform().direction_to_light(d));
    const Vec2<F> uv = plane.place(own);
    F density(0.0f);
    for_each_distribution<F>(light.rows, light.of, Mask<F>(on & (own.z >= F(ProjectionPlane<F>::near))),
                             [&](const PiecewiseConstant2& table, Mask<F> same) {
                               density = select(same, plane.of_direction(table.density(uv), own).value, density);
                             });
    return {density};
  }
  MONTELUX_INLINE Vec2<F> leaving_numbers(Vec3<F> d, Mask<F> on) const {
    Vec2<F> u{F(0.0f), F(0.0f)};
    const Vec3<F> own = normalize(light.rows.transform().direction_to_light(d));
    const Vec2<F> uv = inside_square(ProjectionPlane<F>(light.rows).place(own));
    for_each_distribution<F>(light.rows, light.of, on, [&](const PiecewiseConstant2& table, Mask<F> same) {
      u = select(same, table.invert(uv), u);
    });
    return u;
  }
};

// The interface of every light at one point: what a scene states of it (stated.h); and, made from its row and the
// images of all lights, leave() draws the direction of a ray, leaving_density() is its density (0 where none leaves),
// leaving_numbers() the inverse of leave().
template <class Light, class F>
concept PointLight = requires(const Light& light, Vec3<F> d, Vec2<F> u, Mask<F> on) {
  typename Light::Stated;
  Light(LightRows<F>{}, LightImages{});
  { light.p } -> std::convertible_to<Vec3<F>>;
  { light.intensity(d, on) } -> std::same_as<Spectrum<F>>;
  { light.leave(u, on) } -> std::same_as<LeavingDirection<F>>;
  { light.leaving_density(d, on) } -> std::same_as<Density<SolidAngle, F>>;
  { light.leaving_numbers(d, on) } -> std::same_as<Vec2<F>>;
};

}  // namespace montelux
