// Connections: of two points, of a vertex with a point of a light, and the light that arrives along them.
#pragma once
#include "light/light_set.h"
#include "mc/reuse.h"
#include "transport/stored_vertex.h"
#include "transport/transmittance.h"
#include "transport/visibility.h"

namespace montelux {

// The straight line from one point to another.
template <class F>
struct LineTo {
  Vec3<F> wi;  // unit
  F distance, squared_distance;
};
template <class F>
MONTELUX_INLINE LineTo<F> line_to(const Vec3<F>& from, const Vec3<F>& to) {
  const Vec3<F> way = to - from;
  const F squared = max(length_squared(way), F(1e-30f)), distance = sqrt(squared);
  return {way * (F(1.0f) / distance), distance, squared};
}

// What arrives at a vertex of light from one point.
template <class F>
struct Arriving {
  Spectrum<F> left;  // what the media leave of it, in the lanes `on`
  F passing;         // probability that a path passes participating media without an event, as mean_passing()
  Mask<F> on;        // nothing blocks it
};

// The media along the unit wi, of either kind of vertex.
template <class F>
MONTELUX_INLINE Media<F> media_toward(const Scene&, const Vertex<F>& v, const Vec3<F>& wi) {
  return v.media_toward(wi);
}
template <class F>
MONTELUX_INLINE Media<F> media_toward(const Scene& scene, const StoredOrigin<F>& v, const Vec3<F>& wi) {
  return v.media_toward(scene.media, wi);
}

// From a point at that distance along the unit wi; `v` is a Vertex or a StoredOrigin. `in_media`: the scene has
// participating media. `random` decides for surfaces that are interfaces at times. Without `with_passing` that
// probability is not computed. Adds the rays that are traced to `traced`.
template <class F, bool in_media = false, bool with_passing = true, class V, class Rays>
MONTELUX_INLINE Arriving<F> arriving_from(const Scene& scene, const Rays& rays, const V& v, const Vec3<F>& wi,
                                          F distance, Mask<F> on, const RandomStream<F>& random,
                                          std::uint64_t& traced) {
  const Ray<F> ray = v.shadow_ray_to(wi, distance);
  if constexpr (in_media) {
    const Transmitted<F> seen =
        transmitted<F, with_passing>(scene, rays, ray, media_toward<F>(scene, v, wi), on, random, traced);
    return {seen.left, seen.passing, Mask<F>(on & !is_black(seen.left))};
  } else {
    const Mask<F> open = unblocked<F>(rays, ray, on, traced);
    return {media_toward<F>(scene, v, wi).left(distance), F(1.0f), open};
  }
}

// A vertex and a point of a light, which may block each other's view.
template <class F>
struct LightConnection {
  Vec3<F> wi;
  F distance;
  Spectrum<F> value;  // what the vertex sends on if nothing is in the way, per unit of the light point's measure
  F target;           // the mean of its components
  F geometry;         // as LightPointView has it
  // With which BSDF sampling finds the light point; 0 for a delta light, which no direction meets.
  Density<SolidAngle, F> by_bsdf;
  // Whatever the light is: how the vertex scatters it, and what would arrive along wi (of a delta light, its irradiance
  // at normal incidence).
  BsdfValue<F> scattered;
  Spectrum<F> arriving;
};

template <class F>
LightConnection<F> connect(const MediumSet& media, const LightSet& lights, const StoredOrigin<F>& vertex,
                           const LightPoint<F>& point, Mask<F> on) {
  const LightPointView<F> view = lights.template view<F>(point, vertex.p, vertex.light_normal, on);
  // A flat light contributes nothing to points in its own plane, and no technique samples it there. Rounding could make
  // the target slightly positive, so that this vertex counts among those that could have produced the sample.
  const Mask<F> has_plane = point.place <= in_lanes<F>(LightPlace::two_sided_surface);
  const F rounding = dot(abs(point.n), (abs(vertex.p) + abs(point.p)) * F(0x1p-21f));
  const Mask<F> edge_on = has_plane & (abs(dot(point.n, point.p - vertex.p)) <= rounding);
  const Mask<F> queries = on & view.valid & !edge_on;
  const BsdfValue<F> scattered = vertex.scattered(view.wi, queries);
  const Spectrum<F> arriving = view.radiance * vertex.media_toward(media, view.wi).left(view.distance);
  const Spectrum<F> value = select(queries, scattered.f_cos * arriving * view.geometry, gray(F(0.0f)));
  const Mask<F> met = queries & (point.place != in_lanes<F>(LightPlace::delta));
  return {view.wi,       view.distance,
          value,         usable_weight(average(value)),
          view.geometry, {select(met, scattered.density.value, F(0.0f))},
          scattered,     arriving};
}

// The lanes in which nothing is in the way.
template <class F, class Rays>
Mask<F> is_open(const Rays& rays, const StoredOrigin<F>& vertex, const LightConnection<F>& to, Mask<F> on,
                std::uint64_t& traced) {
  return unblocked<F>(rays, vertex.shadow_ray_to(to.wi, to.distance), on, traced);
}

}  // namespace montelux
