// Direct light at the first surface, by every strategy: for one camera ray (F = float) and for a pack of them.
#pragma once
#include "integrator/branches.h"
#include "integrator/direct/settings.h"
#include "integrator/first_vertex.h"
#include "integrator/path/first_hits.h"
#include "integrator/resampled_light.h"
#include "mc/hemisphere.h"
#include "transport/connection.h"

namespace montelux {

// All that the shadow rays of one vertex share.
template <class F, class Rays, class Tally>
struct DirectLight {
  using U = Uint<F>;
  using M = Mask<F>;
  const Scene& scene;
  const Rays& rays;
  const DirectSettings& settings;
  const NextVertex<F>& at;
  const Branches<F>& numbers;
  RayCounts& counts;
  Tally& tally;
  Spectrum<F> share;  // of one shadow ray's estimate in the pixel

  // One shadow ray's estimate of the light that the vertex sends on.
  Spectrum<F> estimate(std::uint32_t ray, M on) const {
    const M smooth = on & at.bsdf.is_delta, rough = on & !at.bsdf.is_delta;
    Spectrum<F> sum = gray(F(0.0f));
    switch (settings.strategy) {
      case DirectStrategy::light_area:
        sum = toward_light(ray, rough, LightMeasure::area, false);
        break;
      case DirectStrategy::light_solid_angle:
        sum = toward_light(ray, rough, LightMeasure::solid_angle, false);
        break;
      case DirectStrategy::ris:
        sum = resampled(ray, rough);
        break;
      case DirectStrategy::mis:
        return toward_light(ray, rough, LightMeasure::solid_angle, true) + along_bsdf(ray, on, true);
      case DirectStrategy::bsdf:
        return along_bsdf(ray, on, false) + delta_lights(ray, rough);
      case DirectStrategy::uniform:
      case DirectStrategy::cosine:
        sum = along_hemisphere(ray, rough) + delta_lights(ray, rough);
    }
    // A mirror can be answered by its own direction alone.
    return any(smooth) ? sum + along_bsdf(ray, smooth, false) : sum;
  }

 private:
  F heuristic(const Density<SolidAngle, F>& own, const Density<SolidAngle, F>& other) const {
    const F products[2] = {own.value, other.value};
    return mis_weight<F>(settings.heuristic, products, 0);
  }
  // A light that was chosen by u_choice contributes `light`.
  void record_sample(F u_choice, const Spectrum<F>& radiance, M on) const {
    if constexpr (Tally::records) {
      const ReferencePoint<F> from = at.reference();
      tally.template add<F>(
          on, radiance * share,
          {U(1u), scene.lights.template choose<F>(from.p, from.n, u_choice, on).light, Technique::light_sampling});
    }
  }
  LightSample<F> draw_light(F u_choice, Vec2<F> u, LightMeasure measure, M on) const {
    const ReferencePoint<F> from = at.reference();
    return scene.lights.template sample<F>(from.p, from.n, u_choice, u, on, measure);
  }
  BsdfValue<F> scattered(const Vec3<F>& wi, M on) const {
    return evaluate<F>(at.bsdf.lanes(on), at.wo, at.bsdf.frame.to_local(wi), at.context);
  }
  // What arrives of light that comes along wi from that distance. `is_left`: what bodies of glass take on the way has
  // been taken from it.
  Spectrum<F> arriving(const Vec3<F>& wi, F distance, const Spectrum<F>& radiance, M on, bool is_left = false) const {
    const Arriving<F> seen =
        arriving_from<F>(scene, rays, at, wi, distance, M(on & (max_component(radiance) > F(0.0f))),
                         at.context.random.fork(U(vertex_stream::shadow)), counts.shadow);
    return select(seen.on, is_left ? radiance : radiance * seen.left, gray(F(0.0f)));
  }

  // A point of a light; `shared`: the BSDF takes its part by multiple importance sampling.
  Spectrum<F> toward_light(std::uint32_t ray, M on, LightMeasure measure, bool shared) const {
    const F u_choice = numbers.get1(ray, path_dimension::light_choice);
    const LightSample<F> light = draw_light(u_choice, numbers.get2(ray, path_dimension::light_point), measure, on);
    const M queries = on & light.valid;
    const BsdfValue<F> value = scattered(light.wi, queries);
    F weight = F(1.0f) / light.density;
    if (shared) weight = weight * select(light.delta, F(1.0f), heuristic(light.density, value.density));
    const Spectrum<F> contribution = arriving(light.wi, light.distance, value.f_cos * light.radiance * weight, queries);
    record_sample(u_choice, contribution, queries);
    return contribution;
  }

  // Lights that no direction can meet by chance, where the strategy draws directions.
  Spectrum<F> delta_lights(std::uint32_t ray, M on) const {
    if (!scene.lights.has_delta()) return gray(F(0.0f));
    const F u_choice = numbers.get1(ray, path_dimension::light_choice);
    const LightSample<F> light =
        draw_light(u_choice, numbers.get2(ray, path_dimension::light_point), LightMeasure::solid_angle, on);
    const M queries = on & light.valid & light.delta;
    const Spectrum<F> contribution =
        arriving(light.wi, light.distance, scattered(light.wi, queries).f_cos * light.radiance, queries);
    record_sample(u_choice, contribution, queries);
    return contribution;
  }

  // The radiance from a direction of the world; weight(density) as for next_vertex(). `factor` is the share of it that
  // the sample receives.
  template <class Weight>
  Spectrum<F> incoming(const Vec3<F>& wi, std::uint32_t ray, M on, [[maybe_unused]] const Spectrum<F>& factor,
                       Weight weight) const {
    return next_vertex<F>(scene, rays, at.reference_toward(wi), at.ray_toward(wi), on,
                          numbers.stream(ray, path_dimension::per_vertex), counts.scattered, weight,
                          [&]([[maybe_unused]] M meets, [[maybe_unused]] const Spectrum<F>& radiance,
                              [[maybe_unused]] U number, [[maybe_unused]] Technique technique) {
                            if constexpr (Tally::records)
                              tally.template add<F>(meets, radiance * factor * share, {U(1u), number, technique});
                          })
        .emitted;
  }

  Spectrum<F> along_bsdf(std::uint32_t ray, M on, bool shared) const {
    const Vec2<F> u = numbers.get2(ray, path_dimension::direction);
    const BsdfSample<F> next =
        sample<F>(at.bsdf.lanes(on), at.wo, Vec3<F>{numbers.get1(ray, path_dimension::lobe), u.x, u.y}, at.context);
    const M goes = on & next.valid & (max_component(next.weight) > F(0.0f));
    if (!any(goes)) return gray(F(0.0f));
    const Spectrum<F> radiance =
        incoming(at.bsdf.frame.to_world(next.wi), ray, goes, next.weight, [&](const Density<SolidAngle, F>& by_light) {
          return shared ? select(next.delta, F(1.0f), heuristic(next.density, by_light)) : F(1.0f);
        });
    return select(goes, next.weight * radiance, gray(F(0.0f)));
  }

  // A direction uniform in solid angle or projected solid angle, on either side where light can pass through.
  Spectrum<F> along_hemisphere(std::uint32_t ray, M on) const {
    const bool by_cosine = settings.strategy == DirectStrategy::cosine;
    const Vec2<F> u = numbers.get2(ray, path_dimension::direction);
    const M both_sides = length_squared(at.bsdf.light_normal) < F(0.5f);
    const F side = numbers.get1(ray, path_dimension::lobe);
    const M below = select(both_sides, side, F(0.0f)) >= F(0.5f);
    Vec3<F> wi = by_cosine ? sample_cosine_hemisphere(u) : sample_hemisphere(u);
    F density = by_cosine ? cosine_hemisphere_density(wi.z).value : hemisphere_density(wi.z).value;
    density = density * select(both_sides, F(0.5f), F(1.0f));
    // The upper side is that of wo where one side alone scatters.
    const M one_side_below = (at.wo.z < F(0.0f)) & !both_sides;
    const M flip = (both_sides & below) | one_side_below;
    wi.z = select(flip, -wi.z, wi.z);
    const Vec3<F> world = at.bsdf.frame.to_world(wi);
    const BsdfValue<F> value = scattered(world, on);
    const M goes = on & (density > F(0.0f)) & (max_component(value.f_cos) > F(0.0f));
    if (!any(goes)) return gray(F(0.0f));
    const Spectrum<F> radiance = incoming(world, ray, goes, value.f_cos * (F(1.0f) / density), FullWeight{});
    return select(goes, value.f_cos * radiance * (F(1.0f) / density), gray(F(0.0f)));
  }

  Spectrum<F> resampled(std::uint32_t ray, M on) const {
    const ResampledLight<F> chosen = resample_light<F>(
        settings.candidates, numbers.stream(ray, path_dimension::own).fork(U(vertex_stream::resampling)), on,
        [&](F u_choice, Vec2<F> u) { return draw_light(u_choice, u, LightMeasure::solid_angle, on); },
        [&](const LightSample<F>& light, M queries) {
          return scattered(light.wi, queries).f_cos * light.radiance * at.left_of_light(light.wi, light.distance);
        });
    const Spectrum<F> contribution = arriving(chosen.wi, chosen.distance, chosen.value, on, true);
    record_sample(chosen.u_choice, contribution, on & (max_component(contribution) > F(0.0f)));
    return contribution;
  }
};

template <class F, class Rays, class Tally>
RayCounts trace_direct(const Scene& scene, const Rays& rays, const DirectSettings& settings, const TilePass& pass,
                       std::span<PixelSample> out, Tally& tally) {
  using U = Uint<F>;
  using M = Mask<F>;
  FirstHits<F> first_hits(scene, rays, pass, out, tally);
  RayCounts counts;
  counts.camera = first_hits.rays();
  PathState<F> path{};
  const auto n = std::uint32_t(settings.shadow_rays);
  for (;;) {
    const M on = first_hits.refill(path, M(false));
    if (!any(on)) return counts;
    const auto sampler = numbers_of(pass.points, path);
    const U first = U(path_dimension::first_vertex);
    const NextVertex<F> at = first_vertex<F>(scene, rays, path, on, sampler.stream(first + U(path_dimension::own)),
                                             counts, seen_directly(path, tally));

    const std::uint32_t points = settings.fixed ? 1u : n;
    const Branches<F> numbers(pass, {path.x, path.y, path.index}, first, U(0u), points, settings.pattern);
    const DirectLight<F, Rays, Tally> direct{scene,   rays,   settings, at,
                                             numbers, counts, tally,    at.left * (path.weight * (1.0f / float(n)))};
    Spectrum<F> sum = gray(F(0.0f));
    for (std::uint32_t ray = 0; ray < n && any(at.found); ++ray)
      sum += direct.estimate(settings.fixed ? 0u : ray, at.found);
    const Spectrum<F> reflected = select(at.found, at.left * sum * (1.0f / float(n)), gray(F(0.0f)));
    const Spectrum<F> radiance = (at.emitted + reflected) * path.weight;
    for_each_lane(on, [&](int k) { out[lane(path.output, k)].radiance = to_rgb(lane(radiance, k)); });
    if constexpr (Tally::records)
      for_each_lane(on, [&](int k) { tally.finish(k, lane(path.output, k), out[lane(path.output, k)]); });

    write_features(at, sampler, path, out);
  }
}

}  // namespace montelux
