// Photons as paths from the eye look them up, for one path (F = float) and for a pack of them.
#pragma once
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "integrator/photons/photon_map.h"
#include "integrator/photons/settings.h"
#include "transport/next_vertex.h"

namespace montelux {

// Photons on surfaces whose normals have a smaller cosine with that of the gathering point are those of another
// surface.
inline constexpr float similar_normals = 0.7f;

// The density of a photon's place around the gathering point, per area: it integrates to one over the disk.
template <class F>
MONTELUX_INLINE F kernel_weight(PhotonKernel kernel, F distance_squared, F radius_squared) {
  const F inverse = F(1.0f) / radius_squared;
  switch (kernel) {
    case PhotonKernel::constant:
      return inv_pi * inverse;
    case PhotonKernel::cone:  // Jensen 1996, with k = 1
      return max(F(1.0f) - sqrt(distance_squared * inverse), F(0.0f)) * (3 * inv_pi * inverse);
    case PhotonKernel::epanechnikov:
      break;
  }
  return max(F(1.0f) - distance_squared * inverse, F(0.0f)) * (2 * inv_pi * inverse);
}

// A photon near a gathering point, in every lane.
template <class F>
struct FoundPhoton {
  Uint<F> number;                  // in the map
  Uint<F> events;                  // that have scattered it
  Vec3<F> wi;                      // local, to where it came from
  Density<SolidAngle, F> density;  // with which the BSDF samples that
};

// The photons of one frame as the paths from the eye look them up.
class PhotonLookup {
 public:
  PhotonLookup(const PhotonMap& map, PhotonKernel kernel) : map_(map), kernel_(kernel) {}

  // The radiance that photons send along wo. `share(FoundPhoton, on)` is the weight of a photon; 0: it does not count.
  template <class F, class Share>
  Spectrum<F> radiance(const NextVertex<F>& at, const BsdfContext<F>& context, Mask<F> on, Share share) {
    using U = Uint<F>;
    std::size_t most = 0;
    const F radius_squared(map_.radius() * map_.radius());
    for_each_lane(on, [&](int k) {
      std::vector<NearPhoton>& own = near_[std::size_t(k)];
      own.clear();
      map_.near(lane(at.x.point.p, k), lane(at.x.point.ng, k), own);
      most = std::max(most, own.size());
    });
    Spectrum<F> sum = gray(F(0.0f));
    const auto* words = reinterpret_cast<const float*>(map_.photons());
    for (std::size_t i = 0; i < most; ++i) {
      U photon(0u);
      F distance_squared(0.0f);
      std::uint32_t there = 0;
      for_each_lane(on, [&](int k) {
        const std::vector<NearPhoton>& own = near_[std::size_t(k)];
        if (i >= own.size()) return;
        set_lane(photon, k, own[i].photon), set_lane(distance_squared, k, own[i].distance_squared);
        there |= 1u << k;
      });
      const U word = photon * U(photon_words);
      const Vec3<F> wi = gather3<F>(words, word), ng = gather3<F>(words + 3, word);
      const U events = float_bits(gather(words + 6 + spectrum_size, word));
      const Mask<F> similar = mask_of_bits<F>(there) & (abs(dot(ng, at.x.point.ng)) > F(similar_normals));
      if (!any(similar)) continue;
      BsdfContext<F> own = context;
      own.random = context.random.fork(U(0x6a09e667u + std::uint32_t(i)));
      const Vec3<F> local = at.bsdf.frame.to_local(wi);
      const BsdfValue<F> value = evaluate<F>(at.bsdf.lanes(similar), at.wo, local, own);
      const F counted = select(similar, share(FoundPhoton<F>{photon, events, local, value.density}, similar), F(0.0f));
      const Mask<F> counts = counted > F(0.0f);
      // Flux per area is irradiance on the surface itself, f |cos| scatters it by the shading normal.
      const F cos = max(abs(dot(at.x.point.ng, wi)), F(1e-6f));
      const F weight = kernel_weight<F>(kernel_, distance_squared, radius_squared) / cos * counted;
      Spectrum<F> flux;
      for (int c = 0; c < spectrum_size; ++c) flux.c[c] = gather(words + 6 + c, word);
      sum += select(counts, value.f_cos * flux * weight, gray(F(0.0f)));
    }
    return sum;
  }

 private:
  const PhotonMap& map_;
  PhotonKernel kernel_;
  std::array<std::vector<NearPhoton>, native_lanes> near_;
};

}  // namespace montelux
