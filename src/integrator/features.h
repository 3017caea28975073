// What a path shows of its first vertex, for the feature layers.
#pragma once
#include <span>

#include "image/pixel_sample.h"
#include "material/bsdf.h"
#include "scene/surface.h"
#include "transport/path_state.h"
#include "transport/vertex.h"

namespace montelux {

template <class F>
struct FirstSight {
  const SurfacePoint<F>& point;
  Uint<F> object;
  Vec3<F> d;           // of the ray that met the vertex
  F distance;          // along it
  Spectrum<F> light;   // that the camera sees directly
  Spectrum<F> albedo;  // the weight of a sampled direction
};

template <class F>
void write_features(const FirstSight<F>& seen, const PathState<F>& path, Mask<F> on, std::span<PixelSample> out) {
  const Vec3<F> normal = face_forward(seen.point.ns, -seen.d);
  const Spectrum<F> emission = seen.light * path.weight;
  for_each_lane(on, [&](int k) {
    out[lane(path.output, k)].features = {to_rgb(lane(emission, k)), to_rgb(lane(seen.albedo, k)), lane(normal, k),
                                          lane(seen.point.p, k),     lane(seen.distance, k),       1.0f,
                                          lane(seen.object, k)};
  });
}

// The weight of a direction that the BSDF of a vertex samples by these numbers, one for the lobe; black elsewhere.
template <class F>
Spectrum<F> sampled_albedo(const Vertex<F>& at, const Vec3<F>& u, Mask<F> on) {
  const BsdfSample<F> next = sample<F>(at.bsdf.lanes(on), at.wo, u, at.context);
  return select(next.valid & on, next.weight, gray(F(0.0f)));
}

}  // namespace montelux
