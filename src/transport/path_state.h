// All that a path from the eye carries from one vertex to the next, one path a lane, and the steps that change it
// there.
#pragma once
#include "accel/accel.h"
#include "math/lane_words.h"
#include "mc/roulette.h"
#include "scene/geometry_store.h"
#include "transport/media.h"
#include "transport/numbers.h"

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
  Uint<F> by_delta;                // 0: no; 1: that of a delta; 3: only deltas since the camera
  F weight;                        // of the camera and the filter (which may be negative), for the result
  F time;                          // at which the camera looked
  F eta_scale;                     // squared relative indices of refraction crossed; roulette takes it out
  F survival;                      // probability that the path has survived roulette so far
  Uint<F> depth;                   // scattering events so far
  Uint<F> crossings;               // interfaces gone through so far
  Uint<F> x, y, index;             // pixel, and number of the sample there
  Uint<F> output;                  // where the result goes
};

template <class F>
MONTELUX_INLINE Mask<F> by_delta(const PathState<F>& path) {
  return path.by_delta != Uint<F>(0u);
}
// All vertices before the present one are perfect mirrors and smooth glass, or there are none.
template <class F>
MONTELUX_INLINE Mask<F> only_by_deltas(const PathState<F>& path) {
  return path.by_delta == Uint<F>(3u);
}

template <class F>
MONTELUX_INLINE PathSite<F> site_of(const PathState<F>& path) {
  return {path.x, path.y, path.index};
}
// The numbers of the paths, from a source of them: numbers_of(source, site) gives those of one sample of a pixel.
template <class F, class Source>
MONTELUX_INLINE NumberSource<F> auto numbers_of(const Source& source, const PathState<F>& path) {
  return numbers_of(source, site_of(path));
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

// A path that has just met its first surface: what differs from path to path there.
template <class F>
struct PathStart {
  Vec3<F> o, d;
  Hit<F> hit;
  F weight, time;
  Uint<F> x, y, index;
  Uint<F> output;
  Spectrum<F> seen;  // light that its pixel shows directly of other camera rays, over `weight`
};

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
  path.radiance = select(fresh, start.seen, path.radiance);
  path.media = select_media<F>(fresh, media, path.media);
  put(path.p, start.o), put(path.n, zero);
  put_one(path.density.value, F(0.0f)), put_one(path.by_delta, U(3u));
  put_one(path.weight, start.weight), put_one(path.eta_scale, F(1.0f)), put_one(path.survival, F(1.0f));
  put_one(path.time, start.time);
  put_one(path.depth, U(0u)), put_one(path.crossings, U(0u)), put_one(path.x, start.x), put_one(path.y, start.y);
  put_one(path.index, start.index), put_one(path.output, start.output);
}

// ---- from one vertex to the next, in this order: the path scatters, survives roulette, leaves, and is traced

// Multiplies the throughput by the weight of the event. An event whose weight is not finite ends the path, and the
// sample is counted as non-finite. Returns the lanes that continue.
template <class F>
MONTELUX_INLINE Mask<F> scatter_path(PathState<F>& path, const BsdfSample<F>& event, Mask<F> on) {
  const Mask<F> broken = on & !is_finite(max_component(event.weight));
  if (any(broken)) path.radiance += select(broken, event.weight, gray(F(0.0f)));
  const Mask<F> continues = on & !broken;
  path.throughput = select(continues, path.throughput * event.weight, path.throughput);
  path.eta_scale = select(continues, path.eta_scale * event.eta_scale, path.eta_scale);
  path.depth = path.depth + select(continues, Uint<F>(1u), Uint<F>(0u));
  return continues;
}

// Roulette with this chance to survive, decided by u. Returns the lanes that do.
template <class F>
MONTELUX_INLINE Mask<F> survive_roulette(PathState<F>& path, const F& chance, const F& u, Mask<F> on) {
  const Roulette<F> survival = roulette(chance, u);
  const Mask<F> lives = on & survival.survives;
  path.throughput = select(lives, path.throughput * survival.weight, path.throughput);
  path.survival = select(lives, path.survival * chance, path.survival);
  return lives;
}

// The path leaves the vertex v along the unit wi: scattered there by the event, or straight on through an interface.
template <class F, class V>
MONTELUX_INLINE void leave_vertex(PathState<F>& path, const V& v, const Vec3<F>& wi, const BsdfSample<F>& event,
                                  Mask<F> scattered, Mask<F> passes) {
  path.media = select_media<F>(scattered | passes, v.media_toward(wi), path.media);
  path.p = select(scattered, v.x.point.p, path.p), path.n = select(scattered, v.bsdf.light_normal, path.n);
  path.density = select(scattered, event.density, path.density);
  const Uint<F> delta = select(v.bsdf.is_delta, path.by_delta | Uint<F>(1u), Uint<F>(1u));
  path.by_delta = select(scattered, select(event.delta, delta, Uint<F>(0u)), path.by_delta);
  path.o = v.origin_toward(wi), path.d = wi;
  path.crossings = path.crossings + select(passes, Uint<F>(1u), Uint<F>(0u));
}

// The ray along which the path leaves.
template <class F>
MONTELUX_INLINE Ray<F> ray_of(const PathState<F>& path) {
  return {path.o, path.d, F(ray_infinity), path.time};
}
// Traces it to the next surface, whether that scatters or not. Returns the lanes that meet one. Adds the rays to
// `traced`.
template <class F, class Rays>
MONTELUX_INLINE Mask<F> trace_path(PathState<F>& path, const Rays& rays, Mask<F> on, std::uint64_t& traced) {
  traced += std::uint64_t(count(on));
  const auto [found, hit] = rays.template trace<F>(ray_of(path), on);
  path.hit = hit;
  return found;
}

}  // namespace montelux
