// The path loop: the whole estimator on a page, for one path (F = float) and for a pack of them.
#pragma once
#include "integrator/arrival.h"
#include "integrator/path/dimensions.h"
#include "integrator/path/first_hits.h"
#include "integrator/path/path_recorder.h"
#include "integrator/path/settings.h"
#include "integrator/path/survival.h"
#include "integrator/resampled_light.h"
#include "mc/mis.h"
#include "mc/roulette.h"
#include "transport/medium_vertex.h"
#include "transport/transmittance.h"

namespace montelux {

// Numbers of a vertex that are no coordinates of the sample point; they differ from those of materials, which are
// small.
inline constexpr std::uint32_t distance_stream = 0x5bd1e995u, shadow_stream = 0x1b873593u;

// What the first vertex of a path shows goes to the feature layers.
template <class F>
void record_features(const PathState<F>& path, const SurfacePoint<F>& at, const Spectrum<F>& albedo, Uint<F> object,
                     Mask<F> first, std::span<PixelSample> out) {
  Vec3<F> normal = face_forward(at.ns, -path.d);
  F depth = length(at.p - path.p);
  // Before its first event a path has gathered what it saw directly, and nothing else.
  const Spectrum<F> emission = path.radiance * path.weight;
  for_each_lane(first, [&](int k) {
    out[lane(path.slot, k)].features = {to_rgb(lane(emission, k)),
                                        to_rgb(lane(albedo, k)),
                                        lane(normal, k),
                                        lane(at.p, k),
                                        lane(depth, k),
                                        1.0f,
                                        lane(object, k)};
  });
}

// The weight of light that next-event estimation found and BSDF sampling could have found, too.
template <class F>
MONTELUX_INLINE F weight_of_light_sample(const PathSettings& settings, F own, F by_bsdf) {
  if (!settings.nee || settings.mis == PathMis::off) return F(1.0f);
  return settings.mis == PathMis::balance ? balance_weight(own, by_bsdf) : power_weight(own, by_bsdf);
}
// The weight of light that a path met; `own` is 0 where no light sample could have found it.
template <class F>
MONTELUX_INLINE F weight_of_light_hit(const PathSettings& settings, F own, F by_light) {
  if (!settings.nee) return F(1.0f);
  const F shared = settings.mis == PathMis::off       ? F(0.0f)
                   : settings.mis == PathMis::balance ? balance_weight(own, by_light)
                                                      : power_weight(own, by_light);
  return select((own > F(0.0f)) & (by_light > F(0.0f)), shared, F(1.0f));
}

// The probability that a path lives on. Its throughput counts without the squared indices of refraction, which cancel
// on the way out.
template <class F>
MONTELUX_INLINE F survival_probability(const PathSettings& settings, const PathState<F>& path) {
  const F vigour = max_component(path.throughput) * path.eta_scale;
  switch (settings.roulette) {
    case PathRoulette::off:
      return F(1.0f);
    case PathRoulette::fixed:
      return F(settings.fixed_survival);
    case PathRoulette::proportional:
      return min(vigour, F(most_survival));
    case PathRoulette::efficiency:
      return clamp(vigour * settings.survival->template factor<F>(path.x, path.y, path.depth), least_survival,
                   most_survival);
    case PathRoulette::throughput:
      break;
  }
  // The root spares paths that are dim now and may still find a bright place: less noise for the same rays.
  return min(safe_sqrt(vigour), F(most_survival));
}

// A vertex that receives light, as resampled_light takes it.
template <class F>
struct LitVertex {
  Vec3<F> p, light_normal;
  RandomStream<F> random;
  Mask<F> on;
};
// How much a vertex scatters of light from one direction, and what the way to the light leaves of it.
template <class F>
struct ScatteredLight {
  BsdfValue<F> value;
  Spectrum<F> left;
};

// Next-event estimation by resampling. The density of what resampling chooses has no closed form, so the share that
// BSDF sampling has in a light is decided by the density of the candidates, which is known wherever a path may meet
// the light: the weights of the two sum to 1 in every direction, and resampling estimates the integral of its own share
// without bias whatever that is (Veach and Guibas 1995; Talbot, Cline and Egbert 2005, sec. 3). evaluate(light, lanes)
// gives a ScatteredLight.
template <class F, class Evaluate>
ResampledLight<F> resampled_light(const LightSet& lights, const PathSettings& settings, const LitVertex<F>& at,
                                  Evaluate evaluate_light) {
  return resample_light<F>(
      settings.candidates, at.random.fork(Uint<F>(resampling_stream)), at.on,
      [&](F u_choice, Vec2<F> u) { return lights.template sample<F>(at.p, at.light_normal, u_choice, u, at.on); },
      [&](const LightSample<F>& light, Mask<F> wanted) {
        const ScatteredLight<F> scattered = evaluate_light(light, wanted);
        const F share = select(light.delta, F(1.0f),
                               weight_of_light_sample(settings, light.density.value, scattered.value.density.value));
        return scattered.value.f_cos * light.radiance * scattered.left * share;
      });
}

// Light that a path gathers. `origin()` tells the tally where it comes from.
template <class F, class Tally, class Origin>
MONTELUX_INLINE void gather_light(PathState<F>& path, Mask<F> on, const Spectrum<F>& light,
                                  [[maybe_unused]] Tally& tally, [[maybe_unused]] Origin origin) {
  path.radiance += select(on, light, gray(F(0.0f)));
  if constexpr (Tally::records) tally.template add<F>(on, light * path.weight, origin());
}

// The lanes in which a path may count the light that it meets: all, unless the source of the paths says otherwise.
template <class F, class Source>
MONTELUX_INLINE Mask<F> counts_light(const Source& source, const PathState<F>& path, Mask<F> on) {
  if constexpr (requires { source.counts_light(path, on); })
    return source.counts_light(path, on);
  else
    return on;
}

// Paths, one a lane. A lane whose path ends takes the next of the source: source.refill(path, on) fills lanes that are
// off as long as there are paths left, and gives the lanes that are on. `rays` answers trace and occluded as Accel
// does; benchmarks and tests give others. `lights` are the scene's, chosen as the settings ask.
// `in_media`: the scene has participating media; without it they cost nothing.
template <class F, bool in_media = false, class Rays, class Source, class Tally>
RayCounts run_paths(const Scene& scene, const LightSet& lights, const Rays& rays, const PathSettings& settings,
                    const TilePass& pass, std::span<PixelSample> out, Source& source, Tally& tally) {
  using U = Uint<F>;
  using M = Mask<F>;
  RayCounts counts;
  const U max_depth = U(settings.max_depth ? std::uint32_t(*settings.max_depth) : 0x7fffffffu);
  PathState<F> path{};
  // The light from beyond the scene; `left` of it reaches the vertex before.
  const auto gather_sky = [&](M escapes, const Spectrum<F>& left) {
    escapes = counts_light(source, path, escapes);
    for (int i = 0; i < lights.infinite_count() && any(escapes); ++i) {
      LightHit<F> sky = lights.template escaped<F>(i, path.p, path.n, path.d, escapes);
      F weight = weight_of_light_hit(settings, path.density, sky.density.value);
      gather_light(path, escapes, path.throughput * left * sky.radiance * weight, tally, [&] {
        return LightOrigin<F>{path.depth, U(std::uint32_t(lights.infinite_light(i))), Technique::environment};
      });
    }
  };
  const auto finish = [&](M ended) {
    if (!any(ended)) return;
    const Spectrum<F> radiance = path.radiance * path.weight;
    for_each_lane(ended, [&](int k) { out[lane(path.slot, k)].radiance = to_rgb(lane(radiance, k)); });
    if constexpr (Tally::records)
      for_each_lane(ended, [&](int k) { tally.finish(k, lane(path.slot, k), out[lane(path.slot, k)]); });
  };
  M on(false);
  for (;;) {
    on = source.refill(path, on);
    if (!any(on)) return counts;

    const Sampler<F> sampler(pass.points, path.x, path.y, path.index);
    const U dimension = U(path_dimension::first_vertex) + path.depth * U(path_dimension::per_vertex);
    const U own = U(path_dimension::own) + path.crossings * U(path_dimension::per_crossing);
    BsdfContext<F> context{TransportMode::radiance, sampler.stream(dimension + own)};

    // The vertex: a point of a surface, or of a medium before it.
    M meets = on, in_medium(false);
    if constexpr (in_media) meets = on & (path.hit.t < F(ray_infinity));
    SurfaceHit<F> x = surface<F>(scene.geometry, {path.o, path.d, path.hit.t, path.time}, path.hit, meets);
    if constexpr (in_media) {
      if (scene.media.emits())
        gather_light(path, on, path.throughput * scene.media.emitted<F>(path.media.medium, path.hit.t), tally, [&] {
          return LightOrigin<F>{path.depth, U(lights.count()), Technique::bsdf_sampling};  // after all lights
        });
      RandomStream<F> random = context.random.fork(U(distance_stream));
      const F u = random.next();
      const DistanceSample<F> way =
          scene.media.sample_distance<F>(path.media.medium, path.throughput, path.hit.t, {u, random.next()});
      path.throughput = select(on, path.throughput * way.weight, path.throughput);
      in_medium = on & way.is_event, meets = meets & !in_medium;
      put_medium_vertex(in_medium, path.o, path.d, way.distance, x);
    }
    // What the segment leaves of light; a medium that scatters is in the throughput already.
    const auto left_of = [&](const Media<F>& media, F distance) {
      if constexpr (!in_media) return media.left(distance);
      return select(media.medium == U(empty_space), media.left(distance), gray(F(1.0f)));
    };

    // The light that the vertex sends back by itself, or the sky where nothing is met.
    if constexpr (in_media) {
      const M escapes = on & !meets & !in_medium;
      gather_sky(escapes, left_of(path.media, F(ray_infinity)));
      finish(escapes);
      on = on & !escapes;
    }
    const M emits = counts_light(source, path, meets & (x.light != U(0u)));
    if (any(emits)) {
      LightHit<F> light = lights.template hit<F>(select(emits, x.light - U(1u), U(0u)), path.p, path.n, x.point.p,
                                                 x.point.ng, x.point.uv, path.d, emits);
      F weight = weight_of_light_hit(settings, path.density, light.density.value);
      const Spectrum<F> left = left_of(path.media, x.distance);
      gather_light(path, emits, path.throughput * left * light.radiance * weight, tally, [&] {
        return LightOrigin<F>{path.depth, x.light - U(1u), Technique::bsdf_sampling};
      });
    }
    // Interfaces are no events: they are crossed by the last ray, too.
    const M may_scatter = path.depth < max_depth;

    // How it scatters: parameters, frame, and the numbers of this vertex.
    SurfaceScattering<F> bsdf = scene.materials.template scattering<F>(
        x, path.d, meets & (may_scatter | M(scene.materials.has_interfaces())), context.random);
    if constexpr (in_media) put_medium_scattering(in_medium, bsdf);
    const M passes = meets & bsdf.is_interface, scatters = on & may_scatter & !bsdf.is_interface;
    const Vec3<F> wo = bsdf.frame.to_local(-path.d);
    const MediaAt<F> media(path.media, {scene.media, x, bsdf}, path.d);
    path.throughput = select(on, path.throughput * left_of(media.along_wo(), x.distance), path.throughput);
    [[maybe_unused]] const Spectrum<F> arriving = path.throughput;

    // A direction toward a light, and one by the BSDF.
    const M wants_light = scatters & !bsdf.is_delta;
    F light_choice = sampler.get1(dimension + U(path_dimension::light_choice));
    LightSample<F> light = lights.template sample<F>(x.point.p, bsdf.light_normal, light_choice,
                                                     sampler.get2(dimension + U(path_dimension::light_point)),
                                                     settings.candidates > 0 ? M(false) : wants_light);
    const M asks = settings.nee ? wants_light & light.valid : wants_light & light.valid & light.delta;
    const ScatterQuery<F> query{wo, bsdf.frame.to_local(light.wi), asks,
                                sampler.get1(dimension + U(path_dimension::lobe)),
                                sampler.get2(dimension + U(path_dimension::direction))};
    Scattering<F> scattered = scatter<F>(bsdf.lanes(scatters & !in_medium), query, context);
    if constexpr (in_media)
      put_phase_scattering(scatters & in_medium, scene.media.phase<F>(path.media.medium), query, scattered);
    if (M first = on & (path.depth == U(0u)) & !passes; any(first))
      record_features(path, x.point, select(scattered.next.valid & scatters, scattered.next.weight, gray(F(0.0f))),
                      x.object, first, out);

    // Next-event estimation.
    F light_weight =
        select(light.delta, F(1.0f),
               weight_of_light_sample(settings, light.density.value, scattered.toward_light.density.value));
    Spectrum<F> direct =
        path.throughput * scattered.toward_light.f_cos * light.radiance * (light_weight / light.density.value);
    // In media the shadow ray finds the transmittance.
    if constexpr (!in_media) direct *= media.toward(light.wi).left(light.distance);
    M shadow = asks & (max_component(direct) > F(0.0f));
    if (settings.candidates > 0) {
      const ResampledLight<F> chosen =
          resampled_light<F>(lights, settings, {x.point.p, bsdf.light_normal, context.random, wants_light},
                             [&](const LightSample<F>& sample, M wanted) -> ScatteredLight<F> {
                               const Vec3<F> toward = bsdf.frame.to_local(sample.wi);
                               BsdfValue<F> value = evaluate<F>(bsdf.lanes(wanted & !in_medium), wo, toward, context);
                               if constexpr (!in_media) return {value, media.toward(sample.wi).left(sample.distance)};
                               put_phase_value(in_medium, scene.media.phase<F>(path.media.medium), wo, toward, value);
                               return {value, gray(F(1.0f))};
                             });
      direct = path.throughput * chosen.value, light.wi = chosen.wi, light.distance = chosen.distance;
      light_choice = chosen.u_choice;
      shadow = wants_light & (max_component(direct) > F(0.0f));
    }
    if (any(shadow)) {
      const Ray<F> ray = shadow_ray(x.point.p, x.point.p_error, x.point.ng, light.wi, light.distance, path.time);
      M arrives = shadow;
      if constexpr (in_media) {
        direct *= transmittance(scene, rays, ray, media.toward(light.wi), shadow, context.random.fork(U(shadow_stream)),
                                counts.shadow);
      } else {
        counts.shadow += std::uint64_t(count(shadow));
        arrives = shadow & !rays.template occluded<F>(ray, shadow);
      }
      gather_light(path, arrives, direct, tally, [&] {
        // The choice is made once more: the same numbers give the same light.
        const U chosen = lights.template choose<F>(x.point.p, bsdf.light_normal, light_choice, wants_light).light;
        return LightOrigin<F>{path.depth + U(1u), chosen, Technique::light_sampling};
      });
    }

    // Scatter; roulette.
    const BsdfSample<F>& next = scattered.next;
    M goes_on = scatters & next.valid;
    // A weight that is not a number ends the path and shows in the count of such samples.
    const M broken = goes_on & !is_finite(max_component(next.weight));
    if (any(broken)) path.radiance += select(broken, next.weight, gray(F(0.0f)));
    goes_on = goes_on & !broken;
    path.throughput = select(goes_on, path.throughput * next.weight, path.throughput);
    path.eta_scale = select(goes_on, path.eta_scale * next.eta_scale, path.eta_scale);
    path.depth = path.depth + select(goes_on, U(1u), U(0u));
    if constexpr (requires { tally.scattered(path, goes_on); }) tally.scattered(path, goes_on);
    const M plays = goes_on & (path.depth > U(std::uint32_t(settings.roulette_depth)));
    const F chance = select(plays, survival_probability(settings, path), F(1.0f));
    const Roulette<F> survival = roulette(chance, sampler.get1(dimension + U(path_dimension::roulette)));
    goes_on = goes_on & survival.survives;
    path.throughput = select(goes_on, path.throughput * survival.weight, path.throughput);
    Vec3<F> wi = select(passes, path.d, bsdf.frame.to_world(next.wi));
    const M moves = goes_on | passes;
    path.media = select_media<F>(moves, media.toward(wi), path.media);
    path.p = select(goes_on, x.point.p, path.p), path.n = select(goes_on, bsdf.light_normal, path.n);
    path.density = select(goes_on, select(next.delta, F(0.0f), next.density.value), path.density);

    if constexpr (requires { Tally::records_vertices; })
      tally.visit(VertexVisit<F>{x, bsdf, arriving, wi, path.density, chance, on, passes, in_medium, moves});

    // The next vertex, or the sky. In media a ray that meets no surface may still scatter.
    path.o = offset_origin(x.point.p, x.point.p_error, x.point.ng, wi), path.d = wi;
    path.crossings = path.crossings + select(passes, U(1u), U(0u));
    counts.scattered += std::uint64_t(count(moves));
    auto [found, hit] = rays.template trace<F>({path.o, path.d, F(ray_infinity), path.time}, moves);
    path.hit = hit;
    if constexpr (!in_media) gather_sky(moves & !found, path.media.left(F(ray_infinity)));
    const M continues = in_media ? moves : found;
    finish(on & !continues);
    on = on & continues;
  }
}

// A tile's paths, from their camera rays on.
template <class F, bool in_media = false, class Rays, class Tally>
RayCounts trace_paths(const Scene& scene, const LightSet& lights, const Rays& rays, const PathSettings& settings,
                      const TilePass& pass, std::span<PixelSample> out, Tally& tally) {
  FirstHits<F> first_hits(scene, rays, pass, out, tally);
  RayCounts counts = run_paths<F, in_media>(scene, lights, rays, settings, pass, out, first_hits, tally);
  counts.camera += first_hits.rays();
  return counts;
}
template <class F, class Rays>
RayCounts trace_paths(const Scene& scene, const LightSet& lights, const Rays& rays, const PathSettings& settings,
                      const TilePass& pass, std::span<PixelSample> out) {
  return trace_paths<F>(scene, lights, rays, settings, pass, out, no_tally);
}

}  // namespace montelux
