// Light from infinity, the same at every point.
#pragma once
#include "light/image.h"
#include "light/row.h"
#include "light/stated.h"
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

template <class F>
struct InfiniteSample {
  Vec3<F> wi;
  Spectrum<F> factor;  // of the light's emission
  Density<SolidAngle, F> density;
};

// The same radiance from everywhere. If only the side of n matters, directions are cosine-weighted, else
// uniform.
template <class F>
struct UniformInfinite {
  static MONTELUX_INLINE Density<SolidAngle, F> density(Vec3<F> n, Vec3<F> wi) {
    Mask<F> one_side = length_squared(n) > F(0.5f);
    return {select(one_side, cosine_hemisphere_density(dot(n, wi)).value, sphere_density<F>().value)};
  }
  static MONTELUX_INLINE InfiniteSample<F> sample(Vec3<F> n, Vec2<F> u) {
    Mask<F> one_side = length_squared(n) > F(0.5f);
    Vec3<F> axis = select(one_side, n, Vec3<F>{F(0.0f), F(0.0f), F(1.0f)});
    Vec3<F> wi =
        select(one_side, LocalFrame<F>::from_normal(axis).to_world(sample_cosine_hemisphere(u)), sample_sphere(u));
    return {wi, gray(F(1.0f)), density(n, wi)};
  }
  // The numbers that sample wi where no side matters.
  static MONTELUX_INLINE Vec2<F> numbers(Vec3<F> wi) { return invert_sphere(wi); }
};

// A square equal-area image of the sphere (Clarberg 2008), rotated by the light's transform. Radiance is constant
// on a texel, and directions are sampled in proportion to the mean of its components.
template <class F>
struct ImageInfinite {
  const LightImage& image;
  const PiecewiseConstant2& distribution;
  LightTransforms<F> transform;

  MONTELUX_INLINE InfiniteSample<F> sample(Vec2<F> u, Mask<F> on) const {
    PointSample2<F> s = distribution.sample(u);
    Vec3<F> wi = normalize(transform.direction_to_world(sphere_from_square(s.p)));
    return {wi, texels(s.p, on), {s.density.value * inv_four_pi}};
  }
  MONTELUX_INLINE Vec2<F> numbers(Vec3<F> wi) const { return distribution.invert(place_of(wi)); }
  MONTELUX_INLINE InfiniteSample<F> at(Vec3<F> wi, Mask<F> on) const {
    Vec2<F> uv = place_of(wi);
    return {wi, texels(uv, on), {distribution.density(uv).value * inv_four_pi}};
  }

 private:
  MONTELUX_INLINE Vec2<F> place_of(Vec3<F> wi) const {
    return inside_square(square_from_sphere(normalize(transform.direction_to_light(wi))));
  }
  MONTELUX_INLINE Spectrum<F> texels(Vec2<F> uv, Mask<F> on) const {
    Spectrum<F> r = gray(F(0.0f));
    for_each_lane(on, [&](int k) { set_lane(r, k, from_rgb(image.nearest(lane(uv, k)))); });
    return r;
  }
};

}  // namespace montelux
