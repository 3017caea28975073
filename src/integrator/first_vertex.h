// The first vertex of a camera path that scatters, and what it shows.
#pragma once
#include "integrator/features.h"
#include "integrator/integrator.h"
#include "integrator/path/first_hits.h"
#include "transport/next_vertex.h"
#include "transport/numbers.h"
#include "transport/path_state.h"

namespace montelux {

// The vertex to which a path of FirstHits leads, through interfaces, with all light that the camera sees on the way.
// `random` belongs to this vertex.
template <class F, class Rays, class Sink = NoSink>
NextVertex<F> first_vertex(const Scene& scene, const Rays& rays, const PathState<F>& path, Mask<F> on,
                           const RandomStream<F>& random, RayCounts& counts, Sink sink = {}) {
  return follow_ray<F>(scene, rays, free_point(path.o), ray_of(path), path.hit, on, random, counts.scattered,
                       FullWeight{}, sink);
}

// Writes what it shows to the feature layers.
template <class F>
void write_features(const NextVertex<F>& at, const Spectrum<F>& albedo, const PathState<F>& path, Mask<F> on,
                    std::span<PixelSample> out) {
  write_features<F>({at.x.point, at.x.object, at.d, at.distance, at.light, albedo}, path, on, out);
}
// With the albedo by one direction, which the path's own numbers sample.
template <class F, NumberSource<F> Numbers>
void write_features(const NextVertex<F>& at, const Numbers& numbers, const PathState<F>& path,
                    std::span<PixelSample> out) {
  const Uint<F> first(path_dimension::first_vertex);
  const Vec2<F> u = numbers.get2(first + Uint<F>(path_dimension::direction));
  const F lobe = numbers.get1(first + Uint<F>(path_dimension::lobe));
  write_features(at, sampled_albedo<F>(at, {lobe, u.x, u.y}, at.found), path, at.found, out);
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
    const auto numbers = numbers_of(pass.points, path);
    const NextVertex<F> at =
        first_vertex<F>(scene, rays, path, on, numbers.stream(first + U(path_dimension::own)), counts);
    write_features(at, numbers, path, out);
  }
}

}  // namespace montelux
