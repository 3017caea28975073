// Light that comes to the vertices of paths through specular chains, as the path loop takes it.
#pragma once
#include "transport/stored_vertex.h"

namespace montelux {

class ManifoldLight;

// Light that one chain sends to a rough vertex, which scatters it along wo: an estimate of that of all chains.
template <class F>
struct ChainLight {
  Spectrum<F> scattered;
  Uint<F> number;  // of the light
  Uint<F> events;  // scattering events after the light, that at the rough vertex included
};

// ManifoldLight::light() in each of the lanes `on`.
template <class F>
ChainLight<F> chain_light(const ManifoldLight& lights, const StoredVertex<F>& x, Mask<F> on, Uint<F> max_events,
                          std::uint64_t& rays);

extern template ChainLight<float> chain_light(const ManifoldLight&, const StoredVertex<float>&, bool, std::uint32_t,
                                              std::uint64_t&);
extern template ChainLight<NativeFloats> chain_light(const ManifoldLight&, const StoredVertex<NativeFloats>&,
                                                     Mask<NativeFloats>, Uint<NativeFloats>, std::uint64_t&);

}  // namespace montelux
