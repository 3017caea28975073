// Light from infinity, the same at every point.
#pragma once
#include <array>

#include "light/images.h"
#include "light/stated.h"
#include "math/prefetch.h"
#include "math/square_maps.h"
#include "mc/hemisphere.h"
#include "mc/piecewise.h"

namespace montelux {

// Parallel rays in the direction of `to` - `from`.
struct DistantLightDesc {
  SpectrumValue irradiance = gray_value(1);  // at normal incidence, W/m^2
  Vec3f from{0, 0, 0}, to{0, 0, 1};
  std::optional<float> illuminance{};  // lux, to which the light is scaled; as `power`

  static constexpr std::string_view name = "distant", meaning = "parallel rays";
  static Fields<DistantLightDesc> rows();
  std::optional<LightId> add(LightAdder& adder) const;
};

// How an image shows the sphere: `automatic` decides by the aspect ratio.
enum class EnvironmentMapping { equal_area, latlong, automatic };

// An environment.
struct InfiniteLightDesc {
  SpectrumValue radiance = gray_value(1);
  std::string file{};  // instead of `radiance`
  EnvironmentMapping mapping = EnvironmentMapping::equal_area;
  std::optional<float> illuminance{};  // lux of the upward plane, to which the light is scaled; as `power`

  static constexpr std::string_view name = "infinite", meaning = "an environment";
  static Fields<InfiniteLightDesc> rows();
  std::optional<LightId> add(LightAdder& adder) const;
};

// A point of the closed square, moved off the upper edges.
template <class F>
MONTELUX_INLINE Vec2<F> inside_square(Vec2<F> uv) {
  return {min(uv.x, F(one_minus_epsilon)), min(uv.y, F(one_minus_epsilon))};
}

// A direction toward a light without a position.
template <class F>
struct UnboundedSample {
  Vec3<F> wi;          // unit
  Spectrum<F> factor;  // of the light's emission
  Density<SolidAngle, F> density;
};

// The interface of every light without a position, made from its row. `is_delta`: no ray hits it, and densities are 1.
// n is the normal of the side that scatters, as LightSet has it: sample() may depend on it.
template <class Light, class F>
concept UnboundedLight = requires(const Light& l, Vec3<F> w, Vec2<F> u, Mask<F> on) {
  Light(LightRows<F>{}, LightImages{});
  { Light::is_delta } -> std::convertible_to<bool>;
  { l.sample(w, u, on) } -> std::same_as<UnboundedSample<F>>;  // by (n, numbers)
  { l.toward(w, w, on) } -> std::same_as<UnboundedSample<F>>;  // by (n, direction): what sample() gives for it
  { l.numbers(w, on) } -> std::same_as<Vec2<F>>;               // that sample the direction where no side matters
};

// Parallel rays.
template <class F>
struct DistantLight {
  using Stated = DistantLightDesc;
  static constexpr bool is_delta = true;
  Vec3<F> wi;

  MONTELUX_INLINE DistantLight(const LightRows<F>& r, const LightImages&) : wi(r.vec3(light_slot::shape)) {}
  MONTELUX_INLINE UnboundedSample<F> sample(Vec3<F>, Vec2<F>, Mask<F>) const { return {wi, gray(F(1.0f)), {F(1.0f)}}; }
  MONTELUX_INLINE UnboundedSample<F> toward(Vec3<F>, Vec3<F> w, Mask<F>) const { return {w, gray(F(1.0f)), {F(1.0f)}}; }
  MONTELUX_INLINE Vec2<F> numbers(Vec3<F>, Mask<F>) const { return {F(0.0f), F(0.0f)}; }
};

// The same radiance from everywhere. If only the side of n matters, directions are cosine-weighted, else
// uniform.
template <class F>
struct UniformInfinite {
  using Stated = InfiniteLightDesc;
  static constexpr bool is_delta = false;

  MONTELUX_INLINE UniformInfinite(const LightRows<F>&, const LightImages&) {}
  MONTELUX_INLINE UnboundedSample<F> sample(Vec3<F> n, Vec2<F> u, Mask<F> on) const {
    Mask<F> one_side = length_squared(n) > F(0.5f);
    Vec3<F> axis = select(one_side, n, Vec3<F>{F(0.0f), F(0.0f), F(1.0f)});
    Vec3<F> wi =
        select(one_side, LocalFrame<F>::from_normal(axis).to_world(sample_cosine_hemisphere(u)), sample_sphere(u));
    return toward(n, wi, on);
  }
  MONTELUX_INLINE UnboundedSample<F> toward(Vec3<F> n, Vec3<F> wi, Mask<F>) const {
    Mask<F> one_side = length_squared(n) > F(0.5f);
    return {
        wi, gray(F(1.0f)), {select(one_side, cosine_hemisphere_density(dot(n, wi)).value, sphere_density<F>().value)}};
  }
  MONTELUX_INLINE Vec2<F> numbers(Vec3<F> wi, Mask<F>) const { return invert_sphere(wi); }
};

// A square equal-area image of the sphere (Clarberg 2008), rotated by the light's transform. Radiance is constant
// on a texel, and directions are sampled in proportion to the mean of its components.
template <class F>
struct ImageInfinite {
  using Stated = InfiniteLightDesc;
  static constexpr bool is_delta = false;
  LightRows<F> rows;
  LightImages of;

  MONTELUX_INLINE ImageInfinite(const LightRows<F>& r, const LightImages& images) : rows(r), of(images) {}
  MONTELUX_INLINE UnboundedSample<F> sample(Vec3<F>, Vec2<F> u, Mask<F> on) const {
    Vec2<F> uv{F(0.0f), F(0.0f)};
    F density(0.0f);
    for_each_distribution<F>(rows, of, on, [&](const PiecewiseConstant2& table, Mask<F> same) {
      const PointSample2<F> s = table.sample(u);
      uv = select(same, s.p, uv), density = select(same, s.density.value, density);
    });
    const Texels texels = texels_at(uv, on);
    const Vec3<F> wi = normalize(rows.transform().direction_to_world(sphere_from_square(uv)));
    return {wi, read(texels, on), {density * inv_four_pi}};
  }
  // The factor of a sample at that point of the square.
  MONTELUX_INLINE Spectrum<F> factor_at(Vec2<F> uv, Mask<F> on) const { return read(texels_at(uv, on), on); }
  MONTELUX_INLINE UnboundedSample<F> toward(Vec3<F>, Vec3<F> wi, Mask<F> on) const {
    const Vec2<F> uv = place_of(wi);
    const Texels texels = texels_at(uv, on);
    F density(0.0f);
    for_each_distribution<F>(rows, of, on, [&](const PiecewiseConstant2& table, Mask<F> same) {
      density = select(same, table.density(uv).value, density);
    });
    return {wi, read(texels, on), {density * inv_four_pi}};
  }
  MONTELUX_INLINE Vec2<F> numbers(Vec3<F> wi, Mask<F> on) const {
    const Vec2<F> uv = place_of(wi);
    Vec2<F> u{F(0.0f), F(0.0f)};
    for_each_distribution<F>(
        rows, of, on, [&](const PiecewiseConstant2& table, Mask<F> same) { u = select(same, table.invert(uv), u); });
    return u;
  }

 private:
  MONTELUX_INLINE Vec2<F> place_of(Vec3<F> wi) const {
    return inside_square(square_from_sphere(normalize(rows.transform().direction_to_light(wi))));
  }
  // The texel of each lane, whose load has started.
  using Texels = std::array<const Rgb*, std::size_t(lanes_of<F>)>;
  MONTELUX_INLINE Texels texels_at(Vec2<F> uv, Mask<F> on) const {
    Texels texels{};
    const Uint<F> image = rows.bits(light_slot::image);
    for_each_lane(on, [&](int k) {
      texels[std::size_t(k)] = &of.images[lane(image, k) - 1]->nearest(lane(uv, k));
      if constexpr (lanes_of < F >> 1) prefetch(texels[std::size_t(k)]);
    });
    return texels;
  }
  MONTELUX_INLINE static Spectrum<F> read(const Texels& texels, Mask<F> on) {
    Spectrum<F> r = gray(F(0.0f));
    for_each_lane(on, [&](int k) { set_lane(r, k, from_rgb(*texels[std::size_t(k)])); });
    return r;
  }
};

}  // namespace montelux
