// All that a path carries from one vertex to the next, one path a lane.
#pragma once
#include <cstring>

#include "mc/roulette.h"
#include "scene/geometry_store.h"
#include "transport/media.h"

namespace montelux {

template <class F>
struct PathState {
  Vec3<F> o, d;                    // the ray that led to `hit`
  Hit<F> hit;                      // the vertex at hand
  Spectrum<F> throughput;          // product of the weights so far
  Spectrum<F> radiance;            // gathered so far
  Media<F> media;                  // along d
  Vec3<F> p, n;                    // the previous vertex and its normal, as the lights' densities take them
  Density<SolidAngle, F> density;  // of the direction d at the previous vertex, where it is not
  Uint<F> by_delta;                // 1: that of a delta, or of the camera
  F weight;                        // of the camera and the filter (which may be negative), for the result
  F time;                          // at which the camera looked
  F eta_scale;                     // squared relative indices of refraction crossed; roulette takes it out
  Uint<F> depth;                   // scattering events so far
  Uint<F> crossings;               // interfaces gone through so far
  Uint<F> x, y, index;             // pixel, and number of the sample there
  Uint<F> slot;                    // where the result goes
};

template <class F>
MONTELUX_INLINE Mask<F> by_delta(const PathState<F>& path) {
  return path.by_delta != Uint<F>(0u);
}

// What is left of a path, for roulette: its throughput without the squared indices of refraction, which cancel on the
// way out.
template <class F>
MONTELUX_INLINE F roulette_throughput(const PathState<F>& path) {
  return max_component(path.throughput) * path.eta_scale;
}
// The survival probability by throughput. The square root keeps more of the dim paths, which may still reach bright
// regions: less noise for the same rays.
template <class F>
MONTELUX_INLINE F survival_by_throughput(const PathState<F>& path) {
  return min(safe_sqrt(roulette_throughput(path)), F(max_survival));
}

// Which point of which pixel a path belongs to, in every lane.
template <class F>
struct PathSite {
  Uint<F> x, y, index;
};

// A path that has just met its first surface: what differs from path to path there.
template <class F>
struct PathStart {
  Vec3<F> o, d;
  Hit<F> hit;
  F weight, time;
  Uint<F> x, y, index;
  Uint<F> slot;
};

// Copies one lane's worth of a struct that is made of 32-bit words alone into lane k, word by word.
template <template <class> class S, class F>
MONTELUX_INLINE void set_lane_words(S<F>& to_struct, int k, const S<float>& from_struct) {
  static_assert(sizeof(S<F>) == sizeof(S<float>) * lanes_of<F>);
  auto* to = reinterpret_cast<char*>(&to_struct) + 4 * std::size_t(k);
  const auto* from = reinterpret_cast<const char*>(&from_struct);
  for (std::size_t w = 0; w < sizeof(S<float>) / 4; ++w) std::memcpy(to + 4 * w * lanes_of<F>, from + 4 * w, 4);
}
template <template <class> class S, class F>
MONTELUX_INLINE void get_lane_words(const S<F>& from_struct, int k, S<float>& to_struct) {
  auto* to = reinterpret_cast<char*>(&to_struct);
  const auto* from = reinterpret_cast<const char*>(&from_struct) + 4 * std::size_t(k);
  for (std::size_t w = 0; w < sizeof(S<float>) / 4; ++w) std::memcpy(to + 4 * w, from + 4 * w * lanes_of<F>, 4);
}

// Lane by lane a or b, word by word, for such a struct in a pack.
template <template <class> class S, class F>
MONTELUX_INLINE S<F> select_words(Mask<F> m, const S<F>& a, const S<F>& b) {
  static_assert(sizeof(S<F>) == sizeof(S<float>) * lanes_of<F>);
  S<F> result = b;
  auto* to = reinterpret_cast<char*>(&result);
  const auto* from = reinterpret_cast<const char*>(&a);
  for (std::size_t at = 0; at < sizeof(S<F>); at += sizeof(F)) {
    Uint<F> x, y;
    std::memcpy(&x, from + at, sizeof(F)), std::memcpy(&y, to + at, sizeof(F));
    const Uint<F> chosen = select(m, x, y);
    std::memcpy(to + at, &chosen, sizeof(F));
  }
  return result;
}

// Paths begin in the lanes `fresh`, where the starts stand.
template <class F>
MONTELUX_INLINE void begin_paths(PathState<F>& path, const PathStart<F>& start, const Media<F>& media, Mask<F> fresh) {
  using U = Uint<F>;
  auto put = [fresh](auto& to, const auto& from) { to = select<F>(fresh, from, to); };
  const Vec3<F> zero{F(0.0f), F(0.0f), F(0.0f)};
  put(path.o, start.o), put(path.d, start.d);
  auto put_one = [fresh](auto& to, auto from) { to = select(fresh, from, to); };
  put_one(path.hit.t, start.hit.t), put_one(path.hit.u, start.hit.u), put_one(path.hit.v, start.hit.v);
  put_one(path.hit.geometry, start.hit.geometry), put_one(path.hit.primitive, start.hit.primitive);
  put_one(path.hit.instance, start.hit.instance);
  path.throughput = select(fresh, gray(F(1.0f)), path.throughput);
  path.radiance = select(fresh, gray(F(0.0f)), path.radiance);
  path.media = select_media<F>(fresh, media, path.media);
  put(path.p, start.o), put(path.n, zero);
  put_one(path.density.value, F(0.0f)), put_one(path.by_delta, U(1u));
  put_one(path.weight, start.weight), put_one(path.eta_scale, F(1.0f));
  put_one(path.time, start.time);
  put_one(path.depth, U(0u)), put_one(path.crossings, U(0u)), put_one(path.x, start.x), put_one(path.y, start.y);
  put_one(path.index, start.index), put_one(path.slot, start.slot);
}

}  // namespace montelux
