// What one pixel passes to another: the surface point that is lit, and a point of a light that was found.
#pragma once
#include <cmath>

#include "integrator/integrator.h"
#include "integrator/path/path_state.h"
#include "mc/reuse.h"
#include "transport/stored_vertex.h"
#include "transport/visibility.h"

namespace montelux {

// The first surface of a pixel's path that scatters in more than single directions. Made of 32-bit words alone, so that
// pixels can be gathered into lanes.
template <class F>
struct ReuseVertex : StoredVertex<F> {
  Spectrum<F> throughput;  // of the path so far, with the weights of camera and filter
  F depth;                 // distance from the vertex before it, or the camera
  Uint<F> object;          // number of the object, as SurfaceHit has it
  Uint<F> events;          // scattering events of the path before it
  Uint<F> exists;          // 1, or 0: the path ended before
};

// The vertex `v` behind `from`, which gives what belongs to the whole path.
template <class F>
ReuseVertex<F> vertex_behind(const ReuseVertex<F>& from, const Vertex<F>& v) {
  return {stored(v), from.throughput, from.depth, from.object, from.events, from.exists};
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
  // Of BSDF sampling for wi; 0 for a light that is a delta.
  Density<SolidAngle, F> by_bsdf;
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
  const Mask<F> queries = on & view.valid & !edge_on;
  const BsdfValue<F> scattered = vertex.scattered(view.wi, queries);
  const Spectrum<F> arriving = view.radiance * vertex.media_toward(view.wi).left(view.distance);
  const Spectrum<F> value = select(queries, scattered.f_cos * arriving * view.geometry, gray(F(0.0f)));
  const Mask<F> met = queries & (point.sort != Uint<F>(light_point::delta));
  return {view.wi,       view.distance,
          value,         usable_weight(average(value)),
          view.geometry, {select(met, scattered.density.value, F(0.0f))},
          scattered,     arriving};
}

// Where nothing is in the way.
template <class F, class Rays>
Mask<F> is_open(const Rays& rays, const ReuseVertex<F>& vertex, const Connection<F>& to, Mask<F> on,
                RayCounts& counts) {
  return unblocked<F>(rays, vertex.shadow_ray_to(to.wi, to.distance), on, counts.shadow);
}

}  // namespace montelux
