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
  write_features<F>({at.x.point, at.x.object, at.d, at.distance, at.emitted, albedo}, path, on, out);
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

// Mirrors and smooth glass in a row at most beyond which write_first_vertices() looks.
inline constexpr std::uint32_t deepest_shown = 16;

// The features of all samples of a pass, as paths write them, and nothing of its light.
template <class F, class Rays>
RayCounts write_first_vertices(const Scene& scene, const Rays& rays, const TilePass& pass, std::span<PixelSample> out) {
  using U = Uint<F>;
  using M = Mask<F>;
  FirstHits<F> first_hits(scene, rays, pass, out);
  RayCounts counts;
  counts.camera = first_hits.rays();
  PathState<F> path{};
  for (M on(false);;) {
    on = first_hits.refill(path, on);
    if (!any(on)) return counts;
    const auto numbers = numbers_of(pass.points, path);
    const U vertex = U(path_dimension::first_vertex) + path.depth * U(path_dimension::per_vertex);
    const NextVertex<F> at =
        follow_ray<F>(scene, rays, {path.p, path.n, path.media}, ray_of(path), path.hit, on,
                      numbers.stream(vertex + U(path_dimension::own)), counts.scattered, FullWeight{});
    path.throughput = select(on, path.throughput * at.left, path.throughput);
    const Vec2<F> u = numbers.get2(vertex + U(path_dimension::direction));
    const F lobe = numbers.get1(vertex + U(path_dimension::lobe));
    const BsdfSample<F> next = sample<F>(at.bsdf.lanes(at.found), at.wo, Vec3<F>{lobe, u.x, u.y}, at.context);
    write_features(at, albedo_of(at, next, u, at.found), path, at.found, out);

    M moves = at.found & at.bsdf.is_delta & next.valid & (path.depth < U(deepest_shown));
    moves = scatter_path(path, next, moves);
    leave_vertex(path, at, at.bsdf.frame.to_world(next.wi), next, moves, M(false));
    on = moves & trace_path(path, rays, moves, counts.scattered);
  }
}

}  // namespace montelux
