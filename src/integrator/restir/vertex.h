// What one pixel passes to another: the surface point that is lit, and a point of a light that was found.
#pragma once
#include <cmath>

#include "integrator/integrator.h"
#include "mc/reuse.h"
#include "transport/connection.h"
#include "transport/path_state.h"

namespace montelux {

// The first surface of a pixel's path that scatters in more than single directions. Made of 32-bit words alone, so that
// pixels can be gathered into lanes.
template <class F>
struct ReuseVertex : StoredOrigin<F> {
  Spectrum<F> throughput;  // of the path so far, with the weights of camera and filter
  F depth;                 // distance from the vertex before it, or the camera
  Uint<F> object;          // number of the object, as SurfaceHit has it
  Uint<F> events;          // scattering events of the path before it
  Uint<F> exists;          // 1, or 0: the path ended before
};

// The vertex `v` behind `from`, which gives what belongs to the whole path.
template <class F>
ReuseVertex<F> vertex_behind(const ReuseVertex<F>& from, const Vertex<F>& v) {
  return {stored_origin(v), from.throughput, from.depth, from.object, from.events, from.exists};
}

// Surfaces among which reuse pays: normals within 25 degrees, distances within a tenth (Bitterli et al. 2020, sec. 5).
inline bool are_normals_similar(float cosine) { return cosine > 0.906f; }
inline bool are_depths_similar(float a, float b) { return std::abs(a - b) < 0.1f * a; }

template <class F>
using LightReservoir = Reservoir<LightPoint<F>, F>;

}  // namespace montelux
