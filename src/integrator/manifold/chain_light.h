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

// Vertices between a rough vertex and the light, at least and at most.
template <class U>
struct ChainLengths {
  U min, max;
};

// Which vertices of paths find which light of delta lights. Chains go through slightly rough surfaces, too, which light
// sampling from there passes as well. So that each path counts once, the vertex that finds its light is the rough
// vertex farthest from the light of those from which a chain leads there; the others leave it out.
template <class F>
class ChainTail {
 public:
  // Of chains of up to `length` vertices.
  explicit ChainTail(std::uint32_t length) : length_(length) {}

  // The paths have come to a vertex where they scatter, in the lanes `on`. `casts`: it may be part of a chain;
  // `is_first`: it is their first.
  void arrive(Mask<F> casts, Mask<F> is_delta, Mask<F> is_first, Mask<F> on) {
    const Uint<F> far(unrelated), before = select(is_first, far, since_);
    distance_ = select(on & casts & (before < far), before + Uint<F>(1u), far);
    since_ = select(on, select(is_delta, distance_, Uint<F>(0u)), since_);
  }

  // Of the chains that find light at the rough vertex arrived at last, at least; length 0 is light sampling.
  Uint<F> min_length() const {
    return select(distance_ <= Uint<F>(length_), Uint<F>(length_ + 1) - distance_, Uint<F>(0u));
  }

 private:
  static constexpr std::uint32_t unrelated = 1u << 16;
  std::uint32_t length_;
  Uint<F> since_ = Uint<F>(unrelated);     // vertices of a chain since the last rough vertex before
  Uint<F> distance_ = Uint<F>(unrelated);  // the same with the vertex arrived at, if that is part of a chain
};

// Of the chains that are looked for, at most; 0 without a ManifoldLight.
std::uint32_t chain_length(const ManifoldLight* lights);
// Where surfaces may be part of chains.
template <class F>
Mask<F> casts(const ManifoldLight& lights, const SurfaceHit<F>& x, Mask<F> is_delta, Mask<F> on);

// ManifoldLight::light() in each of the lanes `on`.
template <class F>
ChainLight<F> chain_light(const ManifoldLight& lights, const StoredOrigin<F>& x, Mask<F> on,
                          const ChainLengths<Uint<F>>& lengths, std::uint64_t& rays);

extern template ChainLight<float> chain_light(const ManifoldLight&, const StoredOrigin<float>&, bool,
                                              const ChainLengths<std::uint32_t>&, std::uint64_t&);
extern template ChainLight<NativeFloats> chain_light(const ManifoldLight&, const StoredOrigin<NativeFloats>&,
                                                     Mask<NativeFloats>, const ChainLengths<Uint<NativeFloats>>&,
                                                     std::uint64_t&);
extern template bool casts(const ManifoldLight&, const SurfaceHit<float>&, bool, bool);
extern template Mask<NativeFloats> casts(const ManifoldLight&, const SurfaceHit<NativeFloats>&, Mask<NativeFloats>,
                                         Mask<NativeFloats>);

}  // namespace montelux
