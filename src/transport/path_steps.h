// The steps of paths from the eye that go to their next vertex by one call: they arrive at it, and after they have left
// it (path_state.h) they are traced on, to a surface or the sky.
#pragma once
#include "transport/next_vertex.h"
#include "transport/path_state.h"

namespace montelux {

// The vertex to which the rays of paths lead, on which they have met `hit`. The light on the way, as follow_ray() has
// it, is added to the radiance in the lanes `counts`. `random` belongs to this vertex; rays are added to `traced`.
template <class F, class Rays, class Weight, class Sink, class Distances = NoDistances>
NextVertex<F> arrive_path(const Scene& scene, const Rays& rays, PathState<F>& path, Mask<F> on, Mask<F> counts,
                          const RandomStream<F>& random, std::uint64_t& traced, Weight weight, Sink sink,
                          const Distances& distances = {}) {
  const NextVertex<F> at = follow_ray<F>(scene, rays, {path.p, path.n, path.media}, ray_of(path), path.hit, on, random,
                                         traced, weight, sink, distances);
  path.radiance += select(on & counts, path.throughput * at.emitted, gray(F(0.0f)));
  path.throughput = select(on, path.throughput * at.left, path.throughput);
  return at;
}

// Traces paths that have left a vertex. Where they meet no surface, the light of the sky is added in the lanes
// `counts`. Returns the lanes that continue: those on a surface, and with media all, since a ray that meets no surface
// may still scatter. Adds the rays to `traced`.
template <class F, bool in_media, class Rays, class Weight, class Sink>
Mask<F> trace_on(const Scene& scene, const Rays& rays, PathState<F>& path, Mask<F> on, Mask<F> counts,
                 std::uint64_t& traced, Weight weight, Sink sink) {
  const Mask<F> found = trace_path(path, rays, on, traced);
  if constexpr (in_media) return on;
  if (const Mask<F> escapes = on & !found & counts; any(escapes))
    path.radiance +=
        path.throughput * sky_light<F>(scene.lights, {path.p, path.n, path.media}, path.d, escapes, weight, sink);
  return on & found;
}

}  // namespace montelux
