// What a path shows of the scene, for the feature layers: its first surface and, where that is a perfect mirror or
// smooth glass, the colour and the direction of the first surface beyond that scatters.
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
  Vec3<F> d;            // of the ray that met the vertex
  F distance;           // along it
  Spectrum<F> emitted;  // that the camera sees directly
  Spectrum<F> albedo;   // the part of light from everywhere that the vertex returns, or an estimate
};

// The lanes whose vertex the feature layers show: the first one, and each that scatters after nothing but mirrors and
// smooth glass.
template <class F>
MONTELUX_INLINE Mask<F> is_shown(const PathState<F>& path, Mask<F> on, Mask<F> scatters) {
  return on & only_by_deltas(path) & (scatters | (path.depth == Uint<F>(0u)));
}

// Writes the first vertex. Of later ones the albedo, multiplied by those of the mirrors and the glass before it, and
// the normal replace what was written.
template <class F>
void write_features(const FirstSight<F>& seen, const PathState<F>& path, Mask<F> on, std::span<PixelSample> out) {
  const Mask<F> first = on & (path.depth == Uint<F>(0u));
  const Vec3<F> normal = face_forward(seen.point.ns, -seen.d);
  const Spectrum<F> emission = seen.emitted * path.weight;
  // What roulette and the squared indices of refraction do to the light is no property of the surfaces.
  const Spectrum<F> way = select(first, gray(F(1.0f)), path.throughput * (path.eta_scale * path.survival));
  const Spectrum<F> albedo = seen.albedo * way;
  const std::uint32_t firsts = bits(first);
  for_each_lane(on, [&](int k) {
    Features& features = out[lane(path.output, k)].features;
    features.albedo = to_rgb(lane(albedo, k)), features.normal = lane(normal, k);
    if (((firsts >> k) & 1u) == 0) return;
    features.emission = to_rgb(lane(emission, k)), features.position = lane(seen.point.p, k);
    features.depth = lane(seen.distance, k), features.coverage = 1, features.object = lane(seen.object, k);
  });
}

// The albedo of a vertex from which a direction was drawn, in lanes that scatter; black elsewhere. `u`: the numbers of
// that direction.
template <class F>
MONTELUX_INLINE Spectrum<F> albedo_of(const Vertex<F>& at, const BsdfSample<F>& drawn, const Vec2<F>& u, Mask<F> on) {
  if (any(on & estimates_albedo<F>(at.bsdf.kind))) return albedo<F>(at.bsdf.lanes(on), at.wo, drawn, u, at.context);
  return select(on & drawn.valid, drawn.weight * drawn.eta_scale, gray(F(0.0f)));
}

// The same by a direction drawn for it with these numbers, one for the lobe.
template <class F>
Spectrum<F> sampled_albedo(const Vertex<F>& at, const Vec3<F>& u, Mask<F> on) {
  const BsdfSample<F> next = sample<F>(at.bsdf.lanes(on), at.wo, u, at.context);
  return albedo_of(at, next, Vec2<F>{u.y, u.z}, on);
}

}  // namespace montelux
