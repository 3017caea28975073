// Paths that start at lights, for one path (F = float) and for a pack of them: shared by all integrators that follow
// light. A sink defines what happens at each vertex.
#pragma once
#include "integrator/first_vertex.h"
#include "integrator/light_paths/light_media.h"
#include "mc/roulette.h"
#include "transport/numbers.h"

namespace montelux {

// All that the paths of a frame share. `Points` has the numbers of the paths, by numbers_of().
template <class Rays, class Points = PointSet>
struct LightWalkScene {
  const Scene& scene;
  const Rays& rays;
  const AliasTable& by_power;
  Points points;
  Shutter shutter;
  std::optional<float> shutter_sample;  // in [0, 1), of the exposure: of all paths; else each has its own
  std::optional<int> max_depth;         // scattering events, that of the last vertex included
  int roulette_depth;                   // scattering events before roulette
  Densities densities = Densities::for_weights;
  const LightMedia* light_media = nullptr;  // null: the scene has no media
};

// A path on its way, one a lane.
template <class F>
struct LightPathState {
  Ray<F> ray;              // to the next vertex
  ReferencePoint<F> from;  // where it starts
  Spectrum<F> flux;        // that the path carries: what the light sends over the path's density
  F start;                 // the greatest component of the flux with which it left the light
  Uint<F> depth;           // scattering events so far
  Uint<F> smooth;          // how many of these were deltas
  PathSite<F> site;
};

template <class F>
MONTELUX_INLINE LightPathState<F> select_path(Mask<F> m, const LightPathState<F>& a, const LightPathState<F>& b) {
  return {
      {select(m, a.ray.o, b.ray.o), select(m, a.ray.d, b.ray.d), select(m, a.ray.t_max, b.ray.t_max),
       select(m, a.ray.time, b.ray.time)},
      {select(m, a.from.p, b.from.p), select(m, a.from.n, b.from.n), select_media<F>(m, a.from.media, b.from.media)},
      select(m, a.flux, b.flux),
      select(m, a.start, b.start),
      select(m, a.depth, b.depth),
      select(m, a.smooth, b.smooth),
      {select(m, a.site.x, b.site.x), select(m, a.site.y, b.site.y), select(m, a.site.index, b.site.index)}};
}

// The factor by which a shading normal makes the scattering of importance differ from that of radiance (Veach 1997, eq.
// 5.19): from `in`, where light comes from, to `out`; their local directions, and their cosines with the geometric
// normal.
struct AdjointCorrection {
  template <class F>
  MONTELUX_INLINE F operator()(const Vec3<F>& in, F ng_in, const Vec3<F>& out, F ng_out) const {
    const F below = abs(ng_in * out.z);
    return select(below > F(0.0f), abs(in.z * ng_out) / max(below, F(1e-30f)), F(0.0f));
  }
};

// A path that has left its light, as the sink sees it: the light, the ray, the numbers of the path, and its own.
template <class F, class Numbers = Sampler<F>>
struct LightPathStart {
  const DiscreteSample<F>& choice;
  const LightEmission<F>& emission;
  const Numbers& numbers;
  F time;
  const PathSite<F>& site;
};

// A rough or smooth surface that a path has met, or an event in a medium. `flux` arrives there.
template <class F, class Numbers = Sampler<F>>
struct LightPathVertex {
  const NextVertex<F>& at;
  const LightPathState<F>& path;
  F ng_in;  // cosine of the geometric normal with the direction in which the path came
  const Numbers& numbers;
  Uint<F> dimension;  // the first of the numbers of this vertex
};

// The factor by which the vertex scatters importance and radiance differently, for light that leaves along the local
// `out`; ng_out: the cosine of the geometric normal with it.
template <class F, class Correction, bool in_media, class Numbers>
MONTELUX_INLINE F adjoint_correction(const LightPathVertex<F, Numbers>& v, const Vec3<F>& out, F ng_out) {
  const F correction = Correction()(v.at.wo, v.ng_in, out, ng_out);
  if constexpr (!in_media) return correction;
  return select(v.at.in_medium, F(1.0f), correction);
}

// A sink has
//   void leave(LightPathStart, on)              a ray leaves a light
//   Query query(LightPathVertex, on)            .toward: a local direction, .on: where its BSDF value is needed
//   void visit(LightPathVertex, Query, BsdfValue, on)
//   void scatter(LightPathVertex, BsdfSample, on)   optional: the path continues
//   Mask<F> follows(LightPathVertex, BsdfSample, on)   optional: the lanes whose paths may continue
//   F shutter_sample(PathSite)                    optional, where surfaces move: of each path, in the exposure
//   void broken(F value, PathSite, on)          a flux that is not a number, whose path ends
// `Correction` is AdjointCorrection, but in tests that plant a fault. `in_media`: the scene has participating media.
template <class F, class Rays, class Sink, class Correction = AdjointCorrection, bool in_media = false,
          class Points = PointSet>
class LightWalk {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  using Numbers = decltype(numbers_of(std::declval<const Points&>(), std::declval<const PathSite<F>&>()));
  LightWalk(const LightWalkScene<Rays, Points>& shared, Sink& sink, RayCounts& counts)
      : shared_(shared), scene_(shared.scene), sink_(sink), counts_(counts) {}

  // So many paths; site_of(number) is the PathSite<float> of one.
  template <class SiteOf>
  void run(std::uint32_t paths, SiteOf site_of) {
    LightPathState<F> path{};
    M on(false);
    for (std::uint32_t next = 0;;) {
      // Lanes that are off take the next paths.
      PathSite<F> site{U(0u), U(0u), U(0u)};
      std::uint32_t fresh = 0;
      for (int k = 0; k < lanes_of<F> && next < paths; ++k) {
        if ((bits(on) >> k) & 1u) continue;
        const PathSite<float> one = site_of(next);
        set_lane(site.x, k, one.x), set_lane(site.y, k, one.y), set_lane(site.index, k, one.index);
        fresh |= 1u << k, ++next;
      }
      if (fresh != 0) {
        const M starts = mask_of_bits<F>(fresh);
        const auto [state, valid] = start(site, starts);
        path = select_path<F>(starts, state, path);
        on = (on & !starts) | valid;
      }
      if (!any(on)) {
        if (next == paths) return;
        continue;
      }
      on = step(path, on);
    }
  }

  // One path in each lane that is on.
  void run_pack(const PathSite<F>& site, M on) {
    auto [path, valid] = start(site, on);
    for (on = valid; any(on);) on = step(path, on);
  }

 private:
  struct Start {
    LightPathState<F> state;
    M valid;
  };
  F shutter_sample_of(const PathSite<F>& site, const Numbers& numbers) const {
    if constexpr (requires { sink_.shutter_sample(site); }) return sink_.shutter_sample(site);
    return shared_.shutter_sample ? F(*shared_.shutter_sample) : numbers.get1(U(light_dimension::time));
  }
  // A ray from a light.
  Start start(const PathSite<F>& site, M on) {
    const Numbers numbers = numbers_of(shared_.points, site);
    const DiscreteSample<F> choice = shared_.by_power.sample(numbers.get1(U(light_dimension::choice)));
    const LightEmission<F> e = scene_.lights.template emit<F>(choice.index, numbers.get2(U(light_dimension::point)),
                                                              numbers.get2(U(light_dimension::direction)), on);
    F time = 0.0f;
    if (scene_.moves()) time = shared_.shutter.time(shutter_sample_of(site, numbers));
    const Spectrum<F> flux = e.flux * (F(1.0f) / choice.mass.value);
    sink_.leave(LightPathStart<F, Numbers>{choice, e, numbers, time, site}, M(on & e.valid));

    const M carries = on & e.valid & !is_broken(flux, site, on & e.valid) & (max_component(flux) > F(0.0f));
    const M leaves = shared_.max_depth && *shared_.max_depth == 0 ? M(false) : carries;
    const Vec3<F> o = select(e.on_surface, offset_origin(e.p, e.p_error, e.n, e.d), e.p);
    ReferencePoint<F> from = free_point(e.p);
    if (shared_.light_media)
      from.media = shared_.light_media->template around<F>(scene_.media, choice.index, !e.behind, on);
    return {{{o, e.d, F(ray_infinity), time}, from, flux, max_component(flux), U(0u), U(0u), site}, leaves};
  }

  // Goes to the next vertex, shows it to the sink, and scatters there.
  M step(LightPathState<F>& path, M on) {
    const Numbers numbers = numbers_of(shared_.points, path.site);
    const U dimension = U(light_dimension::first_vertex) + path.depth * U(light_dimension::per_vertex);
    NextVertex<F> at = next(path, on, numbers, dimension);
    on = on & at.found;
    path.flux = select(on, path.flux * at.left, path.flux);
    at.context.mode = TransportMode::importance, at.context.densities = shared_.densities;
    const F ng_in = dot(at.x.point.ng, at.d);

    // The BSDF's value for the sink's direction, and a direction that it draws.
    const LightPathVertex<F, Numbers> vertex{at, path, ng_in, numbers, dimension};
    const auto query = sink_.query(vertex, on);
    const Scattering<F> scattered =
        scatter_at<F, in_media>(scene_, at,
                                {at.wo, query.toward, query.on, numbers.get1(dimension + U(light_dimension::lobe)),
                                 numbers.get2(dimension + U(light_dimension::vertex_direction))},
                                on);
    sink_.visit(vertex, query, scattered.toward_light, on);

    const BsdfSample<F>& next = scattered.next;
    const Vec3<F> wi = at.bsdf.frame.to_world(next.wi);
    const U events = path.depth + U(1u);
    M continues = on & next.valid;
    if (shared_.max_depth) continues = continues & (events < U(std::uint32_t(*shared_.max_depth)));
    if constexpr (requires { sink_.follows(vertex, next, continues); })
      continues = continues & sink_.follows(vertex, next, continues);
    const F correction = adjoint_correction<F, Correction, in_media>(vertex, next.wi, dot(at.x.point.ng, wi));
    const Spectrum<F> flux = path.flux * next.weight * correction;
    continues = continues & !is_broken(flux, path.site, continues);
    // Survivors carry the same flux.
    const F share = max_component(flux) / path.start;
    const M plays = continues & (events > U(std::uint32_t(shared_.roulette_depth)));
    const Roulette<F> survival = roulette(select(plays, min(share, F(max_survival)), F(1.0f)),
                                          numbers.get1(dimension + U(light_dimension::roulette)));
    continues = continues & survival.survives;
    if constexpr (requires { sink_.scatter(vertex, next, continues); }) sink_.scatter(vertex, next, continues);
    path.flux = select(continues, flux * survival.weight, path.flux);
    path.depth = select(continues, events, path.depth);
    path.smooth = path.smooth + select(continues & next.delta, U(1u), U(0u));
    path.from.p = select(continues, at.x.point.p, path.from.p);
    path.from.media = select_media<F>(continues, at.media_toward(wi), path.from.media);
    const Ray<F> ray = at.ray_toward(wi);
    path.ray.o = select(continues, ray.o, path.ray.o), path.ray.d = select(continues, ray.d, path.ray.d);
    return continues;
  }

  NextVertex<F> next(const LightPathState<F>& path, M on, const Numbers& numbers, const U& dimension) {
    const auto meet = [&](const auto& distances) {
      return next_vertex<F>(scene_, shared_.rays, path.from, path.ray, on,
                            numbers.stream(dimension + U(light_dimension::own)), counts_.scattered, NoWeight{},
                            NoSink{}, distances);
    };
    if constexpr (in_media)
      return meet(MediumDistances<F, Numbers>{numbers, dimension + U(light_dimension::distance), path.flux});
    else
      return meet(NoDistances{});
  }
  M is_broken(const Spectrum<F>& flux, const PathSite<F>& site, M on) {
    F sum = flux.c[0];
    for (int i = 1; i < spectrum_size; ++i) sum += flux.c[i];
    const M broken = on & !is_finite(sum);
    if (any(broken)) sink_.broken(F(sum - sum), site, broken);
    return broken;
  }

  const LightWalkScene<Rays, Points>& shared_;
  const Scene& scene_;
  Sink& sink_;
  RayCounts& counts_;
};

}  // namespace montelux
