// Transmittance between two points, through media and past surfaces.
#pragma once
#include <utility>

#include "mc/random.h"
#include "scene/scene.h"
#include "transport/vertex.h"
#include "transport/visibility.h"

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
Transmitted<F> transmitted(const Scene& scene, const Rays& rays, const Ray<F>& to, const Media<F>& media, Mask<F> on,
                           RandomStream<F> random, std::uint64_t& traced, RayUse first_use = RayUse::path) {
  Spectrum<F> left = select(on, gray(F(1.0f)), gray(F(0.0f)));
  F passing(1.0f);
  F length = to.t_max * (1.0f / (1.0f - shadow_shortening));  // media fill the whole way, which the rays do not go
  // If every boundary of media scatters, one medium fills the way.
  if (!scene.geometry.has_open_boundaries && first_use == RayUse::path) {
    const Mask<F> open = unblocked<F>(rays, to, on, traced);
    if constexpr (with_passing) passing = select(open, scene.media.mean_passing<F>(media.medium, length), passing);
    return {select(open, media.left(length), gray(F(0.0f))), passing};
  }
  RayUse use = first_use;
  Segment<F> segment{to, {}, media};
  Uint<F> crossings(0u);
  for (Mask<F> open = on; any(open);) {
    traced += std::uint64_t(count(open));
    const auto [found, hit] = rays.template trace<F>(segment.ray, open, std::exchange(use, RayUse::path));
    const F way = select(found, hit.t, length);
    left = select(open, left * segment.media.left(way), left);
    if constexpr (with_passing)
      passing = select(open, passing * scene.media.mean_passing<F>(segment.media.medium, way), passing);
    open = open & found & (max_component(left) > F(0.0f));
    left = select(found & !open, gray(F(0.0f)), left);
    // Most surfaces scatter, whatever their BSDF.
    const Mask<F> may_pass = open & may_be_interface(scene.geometry, hit);
    left = select(open & !may_pass, gray(F(0.0f)), left);
    open = may_pass;
    if (!any(open)) break;
    segment.hit = hit;
    const Vertex<F> v(scene, segment, {open, open}, {TransportMode::radiance, random.fork(crossings)});
    const Mask<F> passes = open & v.bsdf.is_interface;
    left = select(open & !passes, gray(F(0.0f)), left);
    cross_interface(segment, v, passes);
    segment.ray.t_max = select(passes, segment.ray.t_max - hit.t, segment.ray.t_max), length = length - hit.t;
    crossings = crossings + select(passes, Uint<F>(1u), Uint<F>(0u));
    open = passes & (segment.ray.t_max > F(0.0f));
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
