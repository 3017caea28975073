// The path loop: the whole estimator, for one path (F = float) and for a pack of them.
#pragma once
#include <optional>

#include "integrator/features.h"
#include "integrator/guiding/guided_scattering.h"
#include "integrator/manifold/chain_light.h"
#include "integrator/path/first_hits.h"
#include "integrator/path/light_weights.h"
#include "integrator/path/path_recorder.h"
#include "integrator/path/segment_light.h"
#include "integrator/path/settings.h"
#include "integrator/path/survival.h"
#include "integrator/resampled_light.h"
#include "mc/roulette.h"
#include "transport/connection.h"
#include "transport/next_vertex.h"
#include "transport/numbers.h"

namespace montelux {

// Before its first event the radiance of a path contains only directly visible light.
template <class F>
FirstSight<F> first_sight(const PathState<F>& path, const SurfaceHit<F>& x, const Spectrum<F>& albedo) {
  return {x.point, x.object, path.d, length(x.point.p - path.p), path.radiance, albedo};
}

// The probability that a path survives roulette.
template <class F>
MONTELUX_INLINE F survival_probability(const PathSettings& settings, const PathState<F>& path) {
  switch (settings.roulette) {
    case PathRoulette::off:
      return F(1.0f);
    case PathRoulette::fixed:
      return F(settings.fixed_survival);
    case PathRoulette::proportional:
      return min(roulette_throughput(path), F(max_survival));
    case PathRoulette::efficiency:
      return clamp(roulette_throughput(path) * settings.survival->template factor<F>(path.x, path.y, path.depth),
                   min_survival, max_survival);
    case PathRoulette::throughput:
      break;
  }
  return survival_by_throughput(path);
}

// How much a vertex scatters of light from one direction, and what bodies of glass leave of it on its way.
template <class F>
struct ScatteredLight {
  BsdfValue<F> value;
  Spectrum<F> left;
};
// A vertex that receives light, as resampled_light takes it.
template <class F>
struct LitVertex {
  Vec3<F> p, light_normal;
  RandomStream<F> random;
  Mask<F> on;
};

// Next-event estimation by resampling. The density of what resampling chooses has no closed form, so the share that
// BSDF sampling has in a light is decided by the density of the candidates, which is known wherever a path may meet
// the light: the weights of the two sum to 1 in every direction, and resampling estimates the integral of its own share
// without bias whatever that is (Veach and Guibas 1995; Talbot, Cline and Egbert 2005, sec. 3). evaluate(light,
// u_choice, lanes) gives a ScatteredLight.
template <class F, class Evaluate>
ResampledLight<F> resampled_light(const LightSet& lights, const PathSettings& settings, const LitVertex<F>& at,
                                  Evaluate evaluate_light) {
  F chosen_by(0.0f);
  return resample_light<F>(
      settings.candidates, at.random.fork(Uint<F>(vertex_stream::resampling)), at.on,
      [&](F u_choice, Vec2<F> u) {
        chosen_by = u_choice;
        return lights.template sample<F>(at.p, at.light_normal, u_choice, u, at.on);
      },
      [&](const LightSample<F>& light, Mask<F> wanted) {
        const ScatteredLight<F> scattered = evaluate_light(light, chosen_by, wanted);
        const F share = select(
            light.delta, F(1.0f),
            weight_of_light_sample(settings.light_weights(), light.density, scattered.value.density, light.infinite));
        return scattered.value.f_cos * light.radiance * scattered.left * share;
      });
}

// Adds light to a path. `origin()` returns the LightOrigin for the tally.
template <class F, class Tally, class Origin>
MONTELUX_INLINE void gather_light(PathState<F>& path, Mask<F> on, const Spectrum<F>& contribution,
                                  [[maybe_unused]] Tally& tally, [[maybe_unused]] Origin origin) {
  path.radiance += select(on, contribution, gray(F(0.0f)));
  if constexpr (Tally::records) tally.template add<F>(on, contribution * path.weight, origin());
}

// The lanes in which a path may count the light that it meets: all, unless the source of the paths says otherwise.
template <class F, class Source>
MONTELUX_INLINE Mask<F> counts_light(const Source& source, const PathState<F>& path, Mask<F> on) {
  if constexpr (requires { source.counts_light(path, on); })
    return source.counts_light(path, on);
  else
    return on;
}

// The same for the light of emitters alone.
template <class F, class Source>
MONTELUX_INLINE Mask<F> counts_emitter(const Source& source, const PathState<F>& path, Mask<F> on) {
  const Mask<F> counts = counts_light(source, path, on);
  if constexpr (requires { source.counts_emitter(path, counts); })
    return source.counts_emitter(path, counts);
  else
    return counts;
}

// The scattering events of a path at most: `all`, unless the source of the paths ends some of them earlier.
template <class F, class Source>
MONTELUX_INLINE Uint<F> deepest_of(const Source& source, const PathState<F>& path, const Uint<F>& all) {
  if constexpr (requires { source.deepest(path); }) {
    const Uint<F> own = source.deepest(path);
    return select(own < all, own, all);
  } else {
    return all;
  }
}

// The numbers of the paths' sample points: those of the pass, unless the source of the paths has others.
template <class F, class Source>
MONTELUX_INLINE NumberSource<F> auto numbers_of(const Source& source, const TilePass& pass, const PathState<F>& path) {
  if constexpr (requires { source.numbers(path); })
    return source.numbers(path);
  else
    return numbers_of(pass.points, path);
}

// Light that the paths meet, by its share in multiple importance sampling.
template <class F, class Source, class Tally>
struct PathLight {
  static constexpr bool sees_media = true;
  const LightSet& lights;
  const LightWeights weights;
  const Source& source;
  PathState<F>& path;
  Tally& tally;

  MONTELUX_INLINE void emitter(const EmitterOnRay<F>& met, Mask<F> on) {
    on = counts_emitter(source, path, on);
    if (!any(on)) return;
    const LightHit<F> light = emission_met<F>(lights, {path.p, path.n}, met.v.x, path.d, on);
    gather_light(path, on, met.left * light.radiance * share(light, false), tally, [&] {
      return LightOrigin<F>{path.depth, met.v.x.light - Uint<F>(1u), Technique::bsdf_sampling};
    });
  }
  MONTELUX_INLINE void sky(const SkyOnRay<F>& met, Mask<F> on) {
    on = counts_light(source, path, on);
    for_each_sky_light<F>(lights, {path.p, path.n}, path.d, on, [&](const LightHit<F>& light, const Uint<F>& number) {
      gather_light(path, on, met.left * light.radiance * share(light, true), tally, [&] {
        return LightOrigin<F>{path.depth, number, Technique::environment};
      });
    });
  }
  MONTELUX_INLINE void medium(const Spectrum<F>& contribution, Mask<F> on) {
    on = counts_light(source, path, on);
    gather_light(path, on, contribution, tally, [&] {
      return LightOrigin<F>{path.depth, Uint<F>(lights.count()), Technique::bsdf_sampling};  // after all lights
    });
  }

 private:
  F share(const LightHit<F>& light, bool infinite) const {
    return weight_of_light_hit(weights, path.density, by_delta(path), light.density, Mask<F>(infinite));
  }
};

// Paths, one a lane. A lane whose path ends takes the next of the source: source.refill(path, on) fills lanes that are
// off as long as there are paths left, and gives the lanes that are on; source.set_aside(path, on), if it exists, may
// take paths out of their lanes for a while. `rays` has trace() and occluded() as Accel does; benchmarks and tests pass
// others. `lights` are the scene's, chosen as the settings state.
// `in_media`: the scene has participating media; without it they cost nothing. `guide`: NoGuide or FieldGuide.
template <class F, bool in_media = false, class Rays, class Source, class Tally, class Guide = NoGuide>
RayCounts run_paths(const Scene& scene, const LightSet& lights, const Rays& rays, const PathSettings& settings,
                    const TilePass& pass, std::span<PixelSample> out, Source& source, Tally& tally,
                    [[maybe_unused]] const Guide& guide = {}) {
  using U = Uint<F>;
  using M = Mask<F>;
  RayCounts counts;
  const U max_depth = U(settings.max_depth ? std::uint32_t(*settings.max_depth) : 0x7fffffffu);
  const LightWeights weights = settings.light_weights();
  PathState<F> path{};
  [[maybe_unused]] ChainTail<F> chains(chain_length(settings.manifold_light.get()));
  PathLight<F, Source, Tally> met{lights, weights, source, path, tally};
  const auto finish = [&](M ended) {
    if (!any(ended)) return;
    const Spectrum<F> radiance = path.radiance * path.weight;
    for_each_lane(ended, [&](int k) { out[lane(path.output, k)].radiance = to_rgb(lane(radiance, k)); });
    if constexpr (Tally::records)
      for_each_lane(ended, [&](int k) { tally.finish(k, lane(path.output, k), out[lane(path.output, k)]); });
  };
  M on(false);
  for (;;) {
    on = source.refill(path, on);
    if (!any(on)) return counts;

    const auto numbers = numbers_of<F>(source, pass, path);
    const U dimension = U(path_dimension::first_vertex) + path.depth * U(path_dimension::per_vertex);
    const U segment = dimension + path.crossings * U(path_dimension::per_crossing);
    // Interfaces are no events: they are crossed by the last ray, too.
    const M may_scatter = path.depth < deepest_of<F>(source, path, max_depth);

    // The vertex: a point of a surface, or of a medium before it. Light counts by the throughput of the path.
    RayProgress<F> way{{ray_of(path), path.hit, path.media}, path.throughput, F(1.0f), path.crossings};
    // Only where a medium may scatter the light of lamps at one point.
    [[maybe_unused]] std::optional<SegmentLight<F>> segment_light;
    if constexpr (in_media)
      if (lights.has_points()) segment_light.emplace(scene, lights, way.segment, way.left, M(on & may_scatter));
    SegmentEnd<F> end = [&] {
      const RandomStream<F> random = numbers.stream(segment + U(path_dimension::own));
      if constexpr (in_media)
        return end_segment<F>(scene, way, {on, may_scatter}, random, met,
                              MediumDistances<F, std::remove_cv_t<decltype(numbers)>>{
                                  numbers, dimension + U(path_dimension::distance), gray(F(1.0f))});
      else
        return end_segment<F>(scene, way, {on, may_scatter}, random, met);
    }();
    if constexpr (Guide::guides) end.v.context.densities = Densities::exact;
    const Vertex<F>& v = end.v;
    path.throughput = way.left;
    if constexpr (in_media) {
      const M escapes = on & !end.exists();
      finish(escapes);
      on = on & !escapes;
    }
    const M passes = end.passes, scatters = on & may_scatter & !v.bsdf.is_interface;
    [[maybe_unused]] const Spectrum<F> arriving = path.throughput;

    // A direction toward a light, and one by the BSDF.
    const M wants_light = scatters & !v.bsdf.is_delta;
    F light_choice = numbers.get1(dimension + U(path_dimension::light_choice));
    LightSample<F> light = lights.template sample<F>(v.x.point.p, v.bsdf.light_normal, light_choice,
                                                     numbers.get2(dimension + U(path_dimension::light_point)),
                                                     settings.candidates > 0 ? M(false) : wants_light);
    M lit = settings.nee ? wants_light & light.valid : wants_light & light.valid & light.delta;
    // Light of delta lights that chains from vertices before have found.
    M is_found(false);
    if constexpr (!in_media)
      if (settings.manifold_light) {
        chains.arrive(casts<F>(*settings.manifold_light, v.x, v.bsdf.is_delta, scatters), v.bsdf.is_delta,
                      M(path.depth == U(0u)), scatters);
        is_found = chains.min_length() > U(0u);
        lit = lit & !(light.delta & is_found);
      }
    const F lobe = numbers.get1(dimension + U(path_dimension::lobe));
    const Vec2<F> u2 = numbers.get2(dimension + U(path_dimension::direction));
    const auto choice = guide_choice(guide, v, wants_light, lobe);
    Scattering<F> scattered =
        scatter_at<F, in_media>(scene, v, {v.wo, v.bsdf.frame.to_local(light.wi), lit, choice.rest, u2}, scatters);
    [[maybe_unused]] GuidedDirection<F> guided;
    if constexpr (Guide::guides) {
      choice.mix(light.wi, scattered.toward_light.density);
      guided = guide_scattering<F, in_media>(scene, v, choice, u2, wants_light, scattered.next);
    }
    if (const M shown = is_shown(path, M(on & !passes), scatters); any(shown))
      write_features(first_sight(path, v.x, albedo_of(v, scattered.next, u2, scatters & shown)), path, shown, out);

    // Next-event estimation.
    F light_weight =
        select(light.delta, F(1.0f),
               weight_of_light_sample(weights, light.density, scattered.toward_light.density, light.infinite));
    if constexpr (in_media)
      if (segment_light)
        light_weight =
            light_weight * segment_light->share(v.x.point.p, v.x.distance, light, light_choice, M(lit & v.in_medium));
    Spectrum<F> direct =
        path.throughput * scattered.toward_light.f_cos * light.radiance * (light_weight / light.density);
    M shadow = lit & (max_component(direct) > F(0.0f));
    if (settings.candidates > 0) {
      const ResampledLight<F> chosen = resampled_light<F>(
          lights, settings, {v.x.point.p, v.bsdf.light_normal, v.context.random, wants_light},
          [&](const LightSample<F>& sample, [[maybe_unused]] F u_choice, M wanted) -> ScatteredLight<F> {
            BsdfValue<F> value = evaluate_at<F, in_media>(scene, v, v.bsdf.frame.to_local(sample.wi), wanted);
            if constexpr (Guide::guides) choice.mix(sample.wi, value.density);
            // In media the shadow ray finds the transmittance.
            if constexpr (in_media) {
              F share(1.0f);
              if (segment_light) share = segment_light->share(v.x.point.p, v.x.distance, sample, u_choice, v.in_medium);
              return {value, gray(share)};
            }
            const Spectrum<F> left = v.left_of_light(sample.wi, sample.distance);
            return {value, select(sample.delta & is_found, gray(F(0.0f)), left)};
          });
      direct = path.throughput * chosen.value, light.wi = chosen.wi, light.distance = chosen.distance;
      light_choice = chosen.u_choice;
      shadow = wants_light & (max_component(direct) > F(0.0f));
    }
    if (any(shadow)) {
      const Arriving<F> seen =
          arriving_from<F, in_media, false>(scene, rays, v, light.wi, light.distance, shadow,
                                            v.context.random.fork(U(vertex_stream::shadow)), counts.shadow);
      // What is resampled has been weighed by what bodies of glass leave of it.
      const bool is_left = !in_media && settings.candidates > 0;
      gather_light(path, seen.on, is_left ? direct : direct * seen.left, tally, [&] {
        // The choice is made once more: the same numbers give the same light.
        const U chosen = lights.template choose<F>(v.x.point.p, v.bsdf.light_normal, light_choice, wants_light).light;
        return LightOrigin<F>{path.depth + U(1u), chosen, Technique::light_sampling};
      });
    }

    if constexpr (in_media)
      if (segment_light) {
        const auto also = segment_light->sample(
            rays, numbers.stream(segment + U(path_dimension::own)).fork(U(vertex_stream::segment_light)),
            counts.shadow);
        gather_light(path, also.on, also.contribution, tally, [&] {
          return LightOrigin<F>{path.depth + U(1u), also.light, Technique::light_sampling};
        });
      }

    // Light of delta lights that comes by way of mirrors and glass.
    if constexpr (!in_media)
      if (settings.manifold_light && any(wants_light)) {
        const U deepest = max_depth - path.depth;  // at least 1 where light is wanted
        const ChainLengths<U> lengths{chains.min_length(), select(wants_light, deepest - U(1u), U(0u))};
        const ChainLight<F> chain =
            chain_light<F>(*settings.manifold_light, stored_origin(v), wants_light, lengths, counts.shadow);
        gather_light(path, wants_light & (max_component(chain.scattered) > F(0.0f)), path.throughput * chain.scattered,
                     tally, [&] {
                       return LightOrigin<F>{path.depth + chain.events, chain.number, Technique::light_sampling};
                     });
      }

    // Light that the source of the paths knows to come by way of other surfaces; it ends such paths.
    if constexpr (requires { source.indirect_light(path, v, scatters, [](auto&&...) {}); })
      source.indirect_light(path, v, scatters, [&](M known, const Spectrum<F>& sent, const LightOrigin<F>& from) {
        gather_light(path, known, path.throughput * sent, tally, [&] { return from; });
      });

    // Scatter; roulette.
    const BsdfSample<F>& next = scattered.next;
    M continues = scatter_path(path, next, M(scatters & next.valid));
    if constexpr (requires { tally.scattered(path, continues); }) tally.scattered(path, continues);
    if constexpr (requires { Tally::trains_guide; })
      tally.train(path, v, arriving, guided, M(continues & wants_light & !next.delta));
    const M plays = continues & (path.depth > U(std::uint32_t(settings.roulette_depth)));
    const F chance = select(plays, survival_probability(settings, path), F(1.0f));
    continues = survive_roulette(path, chance, numbers.get1(dimension + U(path_dimension::roulette)), continues);
    const Vec3<F> wi = select(passes, path.d, v.bsdf.frame.to_world(next.wi));
    leave_vertex(path, v, wi, next, continues, passes);
    const M moves = continues | passes;
    if constexpr (requires { Tally::records_vertices; })
      tally.visit(VertexVisit<F>{v.x, v.bsdf, arriving, wi, path.density.value, chance, M(passes | by_delta(path)), on,
                                 passes, v.in_medium, moves});

    // The next vertex, or the sky. In media a ray that meets no surface may still scatter.
    const M found = trace_path(path, rays, moves, counts.scattered);
    if constexpr (!in_media)
      if (const M escapes = moves & !found; any(escapes))
        met.sky({path.throughput * path.media.left(F(ray_infinity)), F(1.0f), path.crossings}, escapes);
    const M goes_far = in_media ? moves : found;
    finish(on & !goes_far);
    on = on & goes_far;
    if constexpr (std::is_same_v<std::remove_cv_t<Tally>, NoTally> && requires { source.set_aside(path, on); })
      if (!settings.manifold_light) on = source.set_aside(path, on);
  }
}

// A tile's paths, from their camera rays on.
template <class F, bool in_media = false, class Rays, class Tally, class Guide = NoGuide>
RayCounts trace_paths(const Scene& scene, const LightSet& lights, const Rays& rays, const PathSettings& settings,
                      const TilePass& pass, std::span<PixelSample> out, Tally& tally, const Guide& guide = {}) {
  // Tallies that gather the light of a sample in its lane alone have none.
  constexpr bool has_lamp_rays = !Tally::records || TakesEarlyLight<Tally>;
  const LampRays lamps = has_lamp_rays ? settings.lamps() : LampRays{};
  FirstHits<F> first_hits(scene, rays, pass, out, tally, lamps);
  RayCounts counts = run_paths<F, in_media>(scene, lights, rays, settings, pass, out, first_hits, tally, guide);
  counts.camera += first_hits.rays();
  return counts;
}
template <class F, class Rays>
RayCounts trace_paths(const Scene& scene, const LightSet& lights, const Rays& rays, const PathSettings& settings,
                      const TilePass& pass, std::span<PixelSample> out) {
  return trace_paths<F>(scene, lights, rays, settings, pass, out, no_tally);
}

}  // namespace montelux
