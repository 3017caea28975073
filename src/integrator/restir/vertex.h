// What one pixel hands to another: the surface point at which light is asked for, and a point of a light that was
// found.
#pragma once
#include <cmath>

#include "integrator/arrival.h"
#include "integrator/path/path_state.h"
#include "mc/reuse.h"

namespace montelux {

// The first surface of a pixel's path that scatters in more than single directions, with all that is needed to ask
// again how it scatters. Made of 32-bit words alone, so that pixels can be gathered into lanes.
template <class F>
struct ReuseVertex {
  Vec3<F> p, p_error, ng;
  Vec3<F> wo;  // local
  BsdfSlots<F> slots;
  Uint<F> kind;  // of BsdfKind
  Frame<F> frame;
  Vec3<F> light_normal;    // as SurfaceScattering has it
  RandomStream<F> random;  // of the BSDF: the same numbers whoever asks, so that the BSDF is one function
  Spectrum<F> throughput;  // of the path so far, with the weights of camera and filter
  F depth;                 // distance from the vertex before it, or the camera
  F time;                  // at which the camera looked
  Uint<F> object;          // number of the object, as SurfaceHit has it
  Uint<F> events;          // scattering events of the path before it
  Uint<F> exists;          // 1, or 0: the path ended before
  Media<F> media;          // around the path that arrived here

  // f |cos| toward a direction of the world, and its density.
  BsdfValue<F> scattered(const Vec3<F>& wi, Mask<F> on) const {
    const BsdfContext<F> context{TransportMode::radiance, random, on, Densities::exact};
    return evaluate<F>(BsdfLanes<F>{kind, &slots, on}, wo, frame.to_local(wi), context);
  }
  // The media around the path that continues along wi (world space).
  Media<F> media_toward(const Vec3<F>& wi) const {
    return MediaAt<F>(media, {kind, slots, ng, frame}, -frame.to_world(wo)).toward(wi);
  }
};

// What a path meets at `x`, where it scatters as `bsdf`; `from` gives what belongs to the whole path. `random`: the
// numbers of the BSDF.
template <class F>
ReuseVertex<F> vertex_behind(const ReuseVertex<F>& from, const SurfaceHit<F>& x, const SurfaceScattering<F>& bsdf,
                             const Vec3<F>& d, const RandomStream<F>& random) {
  ReuseVertex<F> v = from;
  v.p = x.point.p, v.p_error = x.point.p_error, v.ng = x.point.ng, v.wo = bsdf.frame.to_local(-d);
  v.slots = bsdf.slots, v.kind = bsdf.kind, v.frame = bsdf.frame, v.light_normal = bsdf.light_normal;
  v.random = random;
  v.media = Boundary<F>(v.kind, v.slots, v.ng, v.frame).before(from.media_toward(d), d);
  return v;
}

// Surfaces among which reuse pays: normals within 25 degrees, distances within a tenth (Bitterli et al. 2020, sec. 5).
inline bool are_normals_similar(float cosine) { return cosine > 0.906f; }
inline bool are_depths_similar(float a, float b) { return std::abs(a - b) < 0.1f * a; }

template <class F>
using LightReservoir = Reservoir<LightPoint<F>, F>;

// A point of a light, joined to a vertex.
template <class F>
struct Connection {
  Vec3<F> wi;
  F distance;
  Spectrum<F> value;  // what the vertex sends on if nothing is in the way, per unit of the light point's measure
  F target;           // the mean of its components
  F geometry;         // as LightPointView has it
  F by_bsdf;          // density of BSDF sampling for wi, solid angle; 0 for a light that is a delta
  // Whatever the light is: how the vertex scatters it, and what would arrive along wi (of a delta light, its irradiance
  // at normal incidence).
  BsdfValue<F> scattered;
  Spectrum<F> arriving;
};

template <class F>
Connection<F> connect(const LightSet& lights, const ReuseVertex<F>& vertex, const LightPoint<F>& point, Mask<F> on) {
  const LightPointView<F> view = lights.template view<F>(point, vertex.p, vertex.light_normal, on);
  // A surface that lies in its own plane sends itself nothing, and no technique finds it there; rounding may say
  // otherwise, by next to nothing, and would be counted among those that could have made the sample.
  const Mask<F> has_plane = point.sort <= Uint<F>(light_point::two_sided_surface);
  const F rounding = dot(abs(point.n), (abs(vertex.p) + abs(point.p)) * F(0x1p-21f));
  const Mask<F> edge_on = has_plane & (abs(dot(point.n, point.p - vertex.p)) <= rounding);
  const Mask<F> asks = on & view.valid & !edge_on;
  const BsdfValue<F> scattered = vertex.scattered(view.wi, asks);
  const Spectrum<F> arriving = view.radiance * vertex.media_toward(view.wi).left(view.distance);
  const Spectrum<F> value = select(asks, scattered.f_cos * arriving * view.geometry, gray(F(0.0f)));
  const Mask<F> met = asks & (point.sort != Uint<F>(light_point::delta));
  return {view.wi,       view.distance,
          value,         usable_weight(average(value)),
          view.geometry, select(met, scattered.density.value, F(0.0f)),
          scattered,     arriving};
}

template <class F>
Ray<F> shadow_ray(const ReuseVertex<F>& vertex, const Vec3<F>& wi, F distance) {
  return shadow_ray(vertex.p, vertex.p_error, vertex.ng, wi, distance, vertex.time);
}
// Where nothing is in the way, along the unit wi.
template <class F, class Rays>
Mask<F> is_open(const Rays& rays, const ReuseVertex<F>& vertex, const Vec3<F>& wi, F distance, Mask<F> on,
                RayCounts& counts) {
  if (!any(on)) return on;
  counts.shadow += std::uint64_t(count(on));
  return on & !rays.template occluded<F>(shadow_ray(vertex, wi, distance), on);
}
template <class F, class Rays>
Mask<F> is_open(const Rays& rays, const ReuseVertex<F>& vertex, const Connection<F>& to, Mask<F> on,
                RayCounts& counts) {
  return is_open<F>(rays, vertex, to.wi, to.distance, on, counts);
}

}  // namespace montelux
