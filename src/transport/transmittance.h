// How much light gets from one point to another: the media on the way, and whatever stands in it.
#pragma once
#include "mc/random.h"
#include "scene/scene.h"
#include "transport/media.h"

namespace montelux {

// The transmittance along rays of shadow_ray() that start in `media`, up to the point that they aim at: zero where a
// surface scatters on the way; interfaces are crossed, and the media behind them absorb as they do. `random` decides
// for surfaces that are interfaces at times. `rays` answers trace as Accel does; counts the rays that it takes.
template <class F, class Rays>
Spectrum<F> transmittance(const Scene& scene, const Rays& rays, Ray<F> ray, Media<F> media, Mask<F> on,
                          RandomStream<F> random, std::uint64_t& traced) {
  Spectrum<F> left = select(on, gray(F(1.0f)), gray(F(0.0f)));
  Uint<F> crossings(0u);
  F length = ray.t_max * (1.0f / (1.0f - shadow_shortening));  // media fill the whole way, which the rays do not go
  for (Mask<F> open = on; any(open);) {
    traced += std::uint64_t(count(open));
    const auto [found, hit] = rays.template trace<F>(ray, open);
    left = select(open, left * media.left(select(found, hit.t, length)), left);
    open = open & found & (max_component(left) > F(0.0f));
    left = select(found & !open, gray(F(0.0f)), left);
    if (!any(open)) break;
    const SurfaceHit<F> x = surface<F>(scene.geometry, {ray.o, ray.d, hit.t, ray.time}, hit, open);
    const SurfaceScattering<F> bsdf = scene.materials.template scattering<F>(x, ray.d, open, random.fork(crossings));
    const Mask<F> passes = open & bsdf.is_interface;
    left = select(open & !passes, gray(F(0.0f)), left);
    const Boundary<F> boundary(scene.media, x, bsdf);
    media = select_media<F>(passes, boundary.behind(media, ray.d, ray.d), media);
    ray.o = select<F>(passes, offset_origin(x.point.p, x.point.p_error, x.point.ng, ray.d), ray.o);
    ray.t_max = select(passes, ray.t_max - hit.t, ray.t_max), length = length - hit.t;
    crossings = crossings + select(passes, Uint<F>(1u), Uint<F>(0u));
    open = passes & (ray.t_max > F(0.0f));
  }
  return left;
}

}  // namespace montelux
