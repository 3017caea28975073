// The first vertex of a camera path that scatters, and what it shows.
#pragma once
#include "integrator/integrator.h"
#include "integrator/path/path_state.h"
#include "transport/next_vertex.h"

namespace montelux {

// The vertex to which a path of FirstHits leads, through interfaces, with all light that the camera sees on the way.
// `random` belongs to this vertex.
template <class F, class Rays, class Sink = NoSink>
NextVertex<F> first_vertex(const Scene& scene, const Rays& rays, const PathState<F>& path, Mask<F> on,
                           const RandomStream<F>& random, RayCounts& counts, Sink sink = {}) {
  return follow_ray<F>(scene, rays, free_point(path.o), {path.o, path.d, F(ray_infinity), path.time}, path.hit, on,
                       random, counts.scattered, FullWeight{}, sink);
}

// Writes what it shows to the feature layers; `albedo` is the weight of a sampled direction.
template <class F>
void write_features(const NextVertex<F>& at, const Spectrum<F>& albedo, const PathState<F>& path, Mask<F> on,
                    std::span<PixelSample> out) {
  const Vec3<F> normal = face_forward(at.x.point.ns, -at.d);
  const Spectrum<F> emission = at.light * path.weight;
  for_each_lane(on, [&](int k) {
    out[lane(path.slot, k)].features = {to_rgb(lane(emission, k)), to_rgb(lane(albedo, k)), lane(normal, k),
                                        lane(at.x.point.p, k),     lane(at.distance, k),    1.0f,
                                        lane(at.x.object, k)};
  });
}

}  // namespace montelux
