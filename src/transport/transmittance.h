// Transmittance between two points, through media and past surfaces.
#pragma once
#include <utility>

#include "mc/random.h"
#include "scene/scene.h"
#include "transport/media.h"

namespace montelux {

// What reaches one point from another.
template <class F>
struct Transmitted {
  Spectrum<F> left;  // of the light
  F passing;         // probability that a path passes the participating media without an event, as mean_passing()
};

// Along rays of shadow_ray() that start in `media`, up to the point that they aim at: nothing is left where a surface
// scatters on the way; interfaces are crossed, and the media behind them absorb as they do. `random` decides for
// surfaces that are interfaces at times. `rays` has trace() as Accel does; counts the rays that it takes. `first_use`
// is that of the ray up to its first surface.
template <class F, bool with_passing = true, class Rays>
Transmitted<F> transmitted(const Scene& scene, const Rays& rays, Ray<F> ray, Media<F> media, Mask<F> on,
                           RandomStream<F> random, std::uint64_t& traced, RayUse first_use = RayUse::path) {
  Spectrum<F> left = select(on, gray(F(1.0f)), gray(F(0.0f)));
  F passing(1.0f);
  RayUse use = first_use;
  Uint<F> crossings(0u);
  F length = ray.t_max * (1.0f / (1.0f - shadow_shortening));  // media fill the whole way, which the rays do not go
  for (Mask<F> open = on; any(open);) {
    traced += std::uint64_t(count(open));
    const auto [found, hit] = rays.template trace<F>(ray, open, std::exchange(use, RayUse::path));
    const F way = select(found, hit.t, length);
    left = select(open, left * media.left(way), left);
    if constexpr (with_passing)
      passing = select(open, passing * scene.media.mean_passing<F>(media.medium, way), passing);
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
  return {left, passing};
}

// What is left of the light alone.
template <class F, class Rays>
Spectrum<F> transmittance(const Scene& scene, const Rays& rays, const Ray<F>& ray, const Media<F>& media, Mask<F> on,
                          RandomStream<F> random, std::uint64_t& traced) {
  return transmitted<F, false>(scene, rays, ray, media, on, random, traced).left;
}

}  // namespace montelux
