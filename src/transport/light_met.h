// Light that a ray meets, with the density that light sampling at the start of the ray had for it.
#pragma once
#include "image/layers.h"
#include "transport/vertex.h"

namespace montelux {

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

// The light from beyond the scene, each infinite light weighted by weight(density), the density with which light
// sampling at `from` would have drawn d. sink(on, light, number, technique) receives each.
template <class F, class Weight, class Sink>
Spectrum<F> sky_light(const LightSet& lights, const ReferencePoint<F>& from, const Vec3<F>& d, Mask<F> on,
                      Weight weight, Sink sink) {
  Spectrum<F> sum = gray(F(0.0f));
  for_each_sky_light<F>(lights, from, d, on, [&](const LightHit<F>& sky, const Uint<F>& number) {
    const Spectrum<F> light =
        select(on, from.media.left(F(ray_infinity)) * sky.radiance * weight(sky.density), gray(F(0.0f)));
    sum += light;
    sink(on, light, number, Technique::environment);
  });
  return sum;
}

}  // namespace montelux
