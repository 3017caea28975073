// The first vertex of a camera path that scatters, and what it shows.
#pragma once
#include "integrator/integrator.h"
#include "integrator/path/first_hits.h"
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

// The features of all samples of a pass; nothing of its light.
template <class F, class Rays>
RayCounts write_first_vertices(const Scene& scene, const Rays& rays, const TilePass& pass, std::span<PixelSample> out) {
  using U = Uint<F>;
  FirstHits<F> first_hits(scene, rays, pass, out);
  RayCounts counts;
  counts.camera = first_hits.rays();
  PathState<F> path{};
  const U first = U(path_dimension::first_vertex);
  for (;;) {
    const Mask<F> on = first_hits.refill(path, Mask<F>(false));
    if (!any(on)) return counts;
    const Sampler<F> numbers(pass.points, path.x, path.y, path.index);
    const NextVertex<F> at =
        first_vertex<F>(scene, rays, path, on, numbers.stream(first + U(path_dimension::own)), counts);
    const Vec2<F> u = numbers.get2(first + U(path_dimension::direction));
    const BsdfSample<F> next = sample<F>(at.bsdf.lanes(at.found), at.wo,
                                         Vec3<F>{numbers.get1(first + U(path_dimension::lobe)), u.x, u.y}, at.context);
    write_features(at, select(next.valid & at.found, next.weight, gray(F(0.0f))), path, at.found, out);
  }
}

}  // namespace montelux
