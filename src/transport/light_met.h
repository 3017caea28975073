// Light that a ray meets, with the density that light sampling at the start of the ray had for it.
#pragma once
#include "image/layers.h"
#include "transport/vertex.h"

namespace montelux {

// Which light a ray meets, and where: a place of its surface, which does not matter for light from beyond the scene.
template <class F>
struct MetLight {
  Uint<F> number;
  Vec3<F> p, n;  // n: unit, on the side of the surface's orientation
  Mask<F> on;
  F passing = F(1.0f);  // probability of no event on the way, as MediumSet::mean_passing
};
// The weight of light that a ray meets depends on the density with which light sampling would have found it; the weight
// may also take the light as an argument.
template <class F, class Weight>
MONTELUX_INLINE F weight_of_met(const Weight& weight, const Density<SolidAngle, F>& density, const MetLight<F>& met) {
  if constexpr (requires { weight(density, met); })
    return weight(density, met);
  else
    return weight(density);
}

// The emission of the surface `x` toward `from`, along -d. The lanes `on` have an emitter.
template <class F>
MONTELUX_INLINE LightHit<F> emission_met(const LightSet& lights, const ReferencePoint<F>& from, const SurfaceHit<F>& x,
                                         const Vec3<F>& d, Mask<F> on) {
  return lights.template hit<F>(select(on, x.light - Uint<F>(1u), Uint<F>(0u)), from.p, from.n, x.point.p, x.point.ng,
                                x.point.uv, d, on);
}

// Calls f(light, number) for each infinite light, as it is met along d where `on`: a LightHit and the light's number.
template <class F, class Function>
MONTELUX_INLINE void for_each_sky_light(const LightSet& lights, const ReferencePoint<F>& from, const Vec3<F>& d,
                                        Mask<F> on, Function f) {
  for (int i = 0; i < lights.infinite_count() && any(on); ++i)
    f(lights.template escaped<F>(i, from.p, from.n, d, on), Uint<F>(std::uint32_t(lights.infinite_light(i))));
}

// The sky that a ray meets where it leaves the scene. `left` of its light reaches the ray's origin, `passing` is as
// MetLight has it, and `crossings` are the interfaces before it.
template <class F>
struct SkyOnRay {
  Spectrum<F> left;
  F passing;
  Uint<F> crossings;
};

// The light from beyond the scene, each infinite light weighted by weight(density), the density with which light
// sampling at `from` would have drawn d. sink(on, light, number, technique) receives each.
template <class F, class Weight, class Sink>
Spectrum<F> sky_light(const LightSet& lights, const ReferencePoint<F>& from, const Vec3<F>& d, const SkyOnRay<F>& met,
                      Mask<F> on, Weight weight, Sink sink) {
  Spectrum<F> sum = gray(F(0.0f));
  for_each_sky_light<F>(lights, from, d, on, [&](const LightHit<F>& sky, const Uint<F>& number) {
    const F share = weight_of_met<F>(weight, sky.density, {number, from.p, -d, on, met.passing});
    const Spectrum<F> radiance = select(on, met.left * (sky.radiance * share), gray(F(0.0f)));
    sum += radiance;
    sink(on, radiance, number, Technique::environment);
  });
  return sum;
}
// The same for rays that cross no interface, through the media of `from`.
template <class F, class Weight, class Sink>
Spectrum<F> sky_light(const LightSet& lights, const ReferencePoint<F>& from, const Vec3<F>& d, Mask<F> on,
                      Weight weight, Sink sink) {
  return sky_light<F>(lights, from, d, {from.media.left(F(ray_infinity)), F(1.0f), Uint<F>(0u)}, on, weight, sink);
}

}  // namespace montelux
