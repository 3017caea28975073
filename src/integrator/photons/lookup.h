// Photons as paths from the eye look them up, for one path (F = float) and for a pack of them.
#pragma once
#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <vector>

#include "integrator/photons/photon_map.h"
#include "integrator/photons/settings.h"
#include "transport/dimensions.h"
#include "transport/next_vertex.h"

namespace montelux {

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

// The same per volume: it integrates to one over the ball.
template <class F>
MONTELUX_INLINE F ball_kernel_weight(PhotonKernel kernel, F distance_squared, F radius_squared) {
  const F inverse = F(1.0f) / radius_squared, scale = inv_pi * inverse * sqrt(inverse);
  switch (kernel) {
    case PhotonKernel::constant:
      return 0.75f * scale;
    case PhotonKernel::cone:
      return max(F(1.0f) - sqrt(distance_squared * inverse), F(0.0f)) * (3 * scale);
    case PhotonKernel::epanechnikov:
      break;
  }
  return max(F(1.0f) - distance_squared * inverse, F(0.0f)) * (1.875f * scale);
}

// A surface that gathers: photons around it arrive on a disk, and its BSDF scatters them.
template <class F>
struct GatheringSurface {
  const NextVertex<F>& at;
  const BsdfContext<F>& context;

  void near(const PhotonMap& map, int k, NearPhotons& found) const {
    map.near(lane(at.x.point.p, k), lane(at.x.point.ng, k), found);
  }
  // Of the i-th photon of each lane, from the local wi.
  BsdfValue<F> scattered(const Vec3<F>& wi, std::size_t i, Mask<F> on) const {
    BsdfContext<F> own = context;
    own.random = context.random.fork(Uint<F>(vertex_stream::photon + std::uint32_t(i)));
    return evaluate<F>(at.bsdf.lanes(on), at.wo, wi, own);
  }
  // Of the irradiance for each unit of flux. Flux per area is irradiance on the surface itself, f |cos| scatters it by
  // the shading normal.
  F density(PhotonKernel kernel, const F& distance_squared, const F& radius_squared, const Vec3<F>& wi) const {
    const F cos = max(abs(dot(at.x.point.ng, wi)), F(1e-6f));
    return kernel_weight<F>(kernel, distance_squared, radius_squared) / cos;
  }
};
// An event in a medium that gathers: photons around it lie in a ball, and its phase function scatters them (Jensen and
// Christensen 1998, "Efficient Simulation of Light Transport in Scenes with Participating Media using Photon Maps",
// eq. 10).
template <class F>
struct GatheringEvent {
  const Scene& scene;
  const NextVertex<F>& at;

  void near(const PhotonMap& map, int k, NearPhotons& found) const { map.near(lane(at.x.point.p, k), found); }
  BsdfValue<F> scattered(const Vec3<F>& wi, std::size_t, Mask<F> on) const {
    return evaluate_at<F, true>(scene, at, wi, on);
  }
  F density(PhotonKernel kernel, const F& distance_squared, const F& radius_squared, const Vec3<F>&) const {
    return ball_kernel_weight<F>(kernel, distance_squared, radius_squared);
  }
};

// A photon near a gathering point, in every lane.
template <class F>
struct FoundPhoton {
  Uint<F> number;                  // in the map
  Uint<F> events;                  // that have scattered it
  Vec3<F> wi;                      // local, to where it came from
  Density<SolidAngle, F> density;  // with which the BSDF samples that
};

// Which photons a path leaves to its own directions and to next-event estimation.
template <class F>
struct PhotonRules {
  float glossy;  // photons count from directions that the BSDF samples with a density of at most this per steradian,
  Uint<F> room;  // if they were scattered by so many events at most
};

// The photons of one frame as the paths from the eye look them up.
class PhotonLookup {
 public:
  // `nearest`: so many photons at most, within the distance of the next one; 0: all within the map's radius.
  // `light_of_path`: the light of each path, for light_of(), which also needs a map that keeps paths.
  PhotonLookup(const PhotonMap& map, PhotonKernel kernel, int nearest = 0, const std::uint32_t* light_of_path = nullptr)
      : map_(map), kernel_(kernel), nearest_(std::size_t(nearest)), light_of_path_(light_of_path) {}

  // The number of the light from which photons come, by their numbers in the map.
  template <class F>
  Uint<F> light_of(const Uint<F>& photon) const {
    return gather(light_of_path_, gather(map_.paths(), photon));
  }

  // The radiance that photons send along wo, at a GatheringSurface or a GatheringEvent. `share(FoundPhoton, on)` is the
  // weight of a photon; 0: it does not count. `sink(FoundPhoton, on, radiance, weight)` receives what each of them
  // contributes.
  template <class F, class Place, class Share, class PhotonSink>
  Spectrum<F> radiance(const Place& place, Mask<F> on, Share share, PhotonSink sink) {
    return any(on) ? scattered<F>(place, on, find<F>(place, on), share, sink) : gray(F(0.0f));
  }
  // The same with the weight 1 or 0.
  template <class F, class Place, class PhotonSink>
  Spectrum<F> radiance_by_rules(const Place& place, Mask<F> on, const PhotonRules<F>& rules, PhotonSink sink) {
    return radiance<F>(
        place, on, [&](const FoundPhoton<F>& photon, Mask<F>) { return weight_of<F>(photon, rules); }, sink);
  }
  // The same without a sink.
  template <class F>
  Spectrum<F> radiance_by_rules(const GatheringEvent<F>& place, Mask<F> on, const PhotonRules<F>& rules) {
    return radiance_by_rules<F>(place, on, rules, NoSink{});
  }
  // Diffuse surfaces scatter the sum of their photons at once.
  template <class F>
  Spectrum<F> radiance_by_rules(const GatheringSurface<F>& place, Mask<F> on, const PhotonRules<F>& rules) {
    if (!any(on)) return gray(F(0.0f));
    const NextVertex<F>& at = place.at;
    const BsdfContext<F>& context = place.context;
    const F radius_squared = find<F>(place, on);
    const Mask<F> diffuse = on & (at.bsdf.kind == Uint<F>(std::uint32_t(kind_of<Diffuse>)));
    Spectrum<F> sum = gray(F(0.0f));
    if (any(diffuse)) {
      const F side = copysign(F(1.0f), at.wo.z);
      const Vec3<F> n = at.bsdf.frame.n * side;
      Spectrum<F> irradiance = gray(F(0.0f));
      for_each_lane(diffuse, [&](int k) {
        const Receiver receiver{lane(n, k), lane(at.x.point.ng, k), lane(radius_squared, k)};
        const Spectrum<float> one = received(near_[std::size_t(k)], receiver, rules.glossy, lane(rules.room, k));
        for (int c = 0; c < spectrum_size; ++c) set_lane(irradiance.c[c], k, one.c[c]);
      });
      // Toward the normal the cosine is 1.
      const BsdfValue<F> value = evaluate<F>(at.bsdf.lanes(diffuse), at.wo, Vec3<F>{F(0.0f), F(0.0f), side}, context);
      sum = select(diffuse, value.f_cos * irradiance, sum);
    }
    if (const Mask<F> others = on & !diffuse; any(others))
      sum += scattered<F>(
          place, others, radius_squared,
          [&](const FoundPhoton<F>& photon, Mask<F>) { return weight_of<F>(photon, rules); }, NoSink{});
    return sum;
  }

 private:
  template <class F>
  static F weight_of(const FoundPhoton<F>& photon, const PhotonRules<F>& rules) {
    return select((photon.density.value <= F(rules.glossy)) & (photon.events <= rules.room), F(1.0f), F(0.0f));
  }
  // A diffuse surface, and what is looked up there.
  struct Receiver {
    Vec3f n, ng;  // the shading normal on the side that is looked at
    float radius_squared;
  };

  // Finds the photons of every lane; gives the squares of the radii within which they lie.
  template <class F, class Place>
  F find(const Place& place, Mask<F> on) {
    F radius_squared(map_.radius() * map_.radius());
    for_each_lane(on, [&](int k) {
      NearPhotons& own = near_[std::size_t(k)];
      place.near(map_, k, own);
      if (nearest_ > 0 && own.count > nearest_) set_lane(radius_squared, k, keep_nearest(own));
    });
    return radius_squared;
  }
  // Keeps the nearest photons; gives the squared distance of the next one, which does not count: where photons are
  // uniform, the mean of (photons that are kept) / (area or volume) is then their density.
  float keep_nearest(NearPhotons& found) {
    // Buckets of equal area leave few to sort.
    constexpr std::size_t buckets = 64;
    const float whole = map_.radius() * map_.radius(), per_bucket = float(buckets) / whole;
    const auto bucket_of = [&](float squared) { return std::min(std::size_t(squared * per_bucket), buckets - 1); };
    std::array<std::uint32_t, buckets> counts{};
    for (std::size_t i = 0; i < found.count; ++i) ++counts[bucket_of(found.distance_squared[i])];
    std::size_t before = 0, bucket = 0;
    while (before + counts[bucket] <= nearest_) before += counts[bucket++];
    within_.clear();
    for (std::size_t i = 0; i < found.count; ++i)
      if (const float squared = found.distance_squared[i]; bucket_of(squared) == bucket) within_.push_back(squared);
    const auto next = within_.begin() + std::ptrdiff_t(nearest_ - before);
    std::nth_element(within_.begin(), next, within_.end());
    const float radius_squared = *next;

    std::size_t kept = 0;
    for (std::size_t i = 0; i < found.count; ++i) {
      if (found.distance_squared[i] >= radius_squared) continue;
      found.photon[kept] = found.photon[i], found.distance_squared[kept++] = found.distance_squared[i];
    }
    found.count = kept;
    return std::max(radius_squared, 1e-12f * whole);  // photons may lie in one point
  }

  // The irradiance of a diffuse surface by its photons, a pack of photons at a time.
  Spectrum<float> received(const NearPhotons& found, const Receiver& at, float glossy, std::uint32_t room) const {
    using F = NativeFloats;
    using U = Uint<F>;
    const auto* words = reinterpret_cast<const float*>(map_.photons());
    Spectrum<F> sum = gray(F(0.0f));
    for (std::size_t i = 0; i < found.count; i += native_lanes) {
      U photon;
      F distance_squared;
      std::memcpy(&photon, found.photon.data() + i, sizeof photon);
      std::memcpy(&distance_squared, found.distance_squared.data() + i, sizeof distance_squared);
      const Mask<F> there = lane_index<F>() < U(std::uint32_t(found.count - i));
      const U word = select(there, photon, U(0u)) * U(photon_words);
      const Vec3<F> wi = gather3<F>(words, word);
      const U events = float_bits(gather(words + 3 + spectrum_size, word));
      const F cos = dot(wi, splat<F>(at.n));
      const Mask<F> counts = there & (cos > F(0.0f)) & (cos * inv_pi <= F(glossy)) & (events <= U(room));
      const F cos_g = max(abs(dot(wi, splat<F>(at.ng))), F(1e-6f));
      const F weight = kernel_weight<F>(kernel_, distance_squared, F(at.radius_squared)) * (cos / cos_g);
      for (int c = 0; c < spectrum_size; ++c) sum.c[c] += select(counts, gather(words + 3 + c, word) * weight, F(0.0f));
    }
    Spectrum<float> all = gray(0.0f);
    for (int c = 0; c < spectrum_size; ++c)
      for (int k = 0; k < native_lanes; ++k) all.c[c] += lane(sum.c[c], k);
    return all;
  }

  // What photons send along wo, one photon of each lane at a time.
  template <class F, class Place, class Share, class PhotonSink>
  Spectrum<F> scattered(const Place& place, Mask<F> on, const F& radius_squared, Share share, PhotonSink sink) const {
    using U = Uint<F>;
    std::size_t max_found = 0;
    for_each_lane(on, [&](int k) { max_found = std::max(max_found, near_[std::size_t(k)].count); });
    Spectrum<F> sum = gray(F(0.0f));
    const auto* words = reinterpret_cast<const float*>(map_.photons());
    for (std::size_t i = 0; i < max_found; ++i) {
      U photon(0u);
      F distance_squared(0.0f);
      std::uint32_t there = 0;
      for_each_lane(on, [&](int k) {
        const NearPhotons& own = near_[std::size_t(k)];
        if (i >= own.count) return;
        set_lane(photon, k, own.photon[i]), set_lane(distance_squared, k, own.distance_squared[i]);
        there |= 1u << k;
      });
      const Mask<F> similar = mask_of_bits<F>(there);
      const U word = photon * U(photon_words);
      const Vec3<F> wi = gather3<F>(words, word);
      const U events = float_bits(gather(words + 3 + spectrum_size, word));
      const Vec3<F> local = place.at.bsdf.frame.to_local(wi);
      const BsdfValue<F> value = place.scattered(local, i, similar);
      const FoundPhoton<F> found{photon, events, local, value.density};
      const F counted = select(similar, share(found, similar), F(0.0f));
      const Mask<F> counts = counted > F(0.0f);
      const F weight = place.density(kernel_, distance_squared, radius_squared, wi) * counted;
      Spectrum<F> flux;
      for (int c = 0; c < spectrum_size; ++c) flux.c[c] = gather(words + 3 + c, word);
      const Spectrum<F> radiance = select(counts, value.f_cos * flux * weight, gray(F(0.0f)));
      sum += radiance;
      sink(found, counts, radiance, counted);
    }
    return sum;
  }

  const PhotonMap& map_;
  PhotonKernel kernel_;
  std::size_t nearest_;
  const std::uint32_t* light_of_path_;
  std::array<NearPhotons, native_lanes> near_;
  std::vector<float> within_;
};

// Those of a frame's maps.
struct PhotonLookups {
  PhotonLookup surfaces;
  std::optional<PhotonLookup> media = {};  // of events in media; none: there are no media
};

}  // namespace montelux
