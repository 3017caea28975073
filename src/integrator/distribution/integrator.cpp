#include "integrator/distribution/integrator.h"

#include <algorithm>

#include "integrator/branches.h"
#include "integrator/first_vertex.h"
#include "integrator/path/first_hits.h"
#include "mc/roulette.h"
#include "transport/connection.h"

namespace montelux {

namespace {

using F = float;
using U = std::uint32_t;

int at_depth(const std::vector<int>& counts, U depth) {
  return counts[std::min<std::size_t>(depth, counts.size() - 1)];
}

// The way from the camera to a surface.
struct Way {
  Spectrum<float> throughput;  // as the roulette takes it: of one of the branches
  Spectrum<float> share;       // of what the surface sends on in the pixel
};

// The tree of rays that grows from one camera ray.
template <class Tally>
struct Tree {
  const Scene& scene;
  const Accel& accel;
  const DistributionSettings& settings;
  const TilePass& pass;
  PathSite<F> site;
  RayCounts& counts;
  Tally& tally;

  // Light that the surface scatters. `vertex` is the surface's number in the tree.
  Spectrum<float> reflected(const NextVertex<F>& at, U depth, U vertex, const Way& way) {
    if (settings.max_depth && depth >= U(*settings.max_depth)) return gray(0.0f);
    const auto directions = U(at_depth(settings.branching, depth));
    // Lights that no ray can meet need a shadow ray.
    const U wanted = std::max(U(at_depth(settings.shadow_rays, depth)), scene.lights.has_delta() ? 1u : 0u);
    const U points = at.bsdf.is_delta ? 0 : wanted;
    const U first = path_dimension::first_vertex + depth * path_dimension::per_vertex;
    const Branches<F> lights(pass, site, first, vertex, std::max(points, 1u));
    const Branches<F> numbers(pass, site, first, vertex, directions);
    Spectrum<float> sum = gray(0.0f);
    for (U i = 0; i < points; ++i) sum += toward_light(at, lights, i, {points, directions}, depth, way);
    for (U i = 0; i < directions; ++i)
      sum += along_bsdf(at, numbers, i, {points, directions}, depth, mix_bits(vertex * 0x9e3779b9u + i + 1), way);
    return sum;
  }

 private:
  struct Techniques {
    U points, directions;  // samples of each technique at a vertex
  };

  Spectrum<float> toward_light(const NextVertex<F>& at, const Branches<F>& numbers, U i, Techniques n, U depth,
                               const Way& way) {
    const ReferencePoint<F> from = at.reference();
    const F u_choice = numbers.get1(i, path_dimension::light_choice);
    const LightSample<F> light =
        scene.lights.sample<F>(from.p, from.n, u_choice, numbers.get2(i, path_dimension::light_point), true);
    if (!light.valid) return gray(0.0f);
    const BsdfValue<F> value = evaluate<F>(at.bsdf.lanes(true), at.wo, at.bsdf.frame.to_local(light.wi), at.context);
    const float weight =
        light.delta ? 1.0f : power_weight(float(n.points), light.density, float(n.directions), value.density);
    Spectrum<float> direct = value.f_cos * light.radiance * (weight / (float(n.points) * light.density));
    if (!(max_component(direct) > 0)) return gray(0.0f);
    const Arriving<F> seen = arriving_from<F>(scene, accel, at, light.wi, light.distance, true,
                                              at.context.random.fork(vertex_stream::shadow), counts.shadow);
    if (!seen.on) return gray(0.0f);
    direct *= seen.left;
    if constexpr (Tally::records)
      tally.template add<F>(
          true, direct * way.share,
          {depth + 1, scene.lights.choose<F>(from.p, from.n, u_choice, true).light, Technique::light_sampling});
    return direct;
  }

  Spectrum<float> along_bsdf(const NextVertex<F>& at, const Branches<F>& numbers, U i, Techniques n, U depth, U vertex,
                             const Way& way) {
    const Vec2f u = numbers.get2(i, path_dimension::direction);
    BsdfContext<F> context = at.context;
    context.random = context.random.fork(i);
    const BsdfSample<F> next =
        sample<F>(at.bsdf.lanes(true), at.wo, Vec3f{numbers.get1(i, path_dimension::lobe), u.x, u.y}, context);
    if (!next.valid || !(max_component(next.weight) > 0)) return gray(0.0f);
    Spectrum<float> weight = next.weight * (1.0f / float(n.directions));
    const Spectrum<float> onward = way.throughput * weight;
    // Where the tree has become a path, it ends by roulette.
    if (n.directions == 1 && depth >= 2) {
      const Roulette<F> survival =
          roulette(std::min(std::sqrt(max_component(onward)), max_survival), numbers.get1(i, path_dimension::roulette));
      if (!survival.survives) return gray(0.0f);
      weight *= gray(survival.weight);
    }
    const Vec3f wi = at.bsdf.frame.to_world(next.wi);
    count_ray(depth + 1);
    const NextVertex<F> there = next_vertex<F>(
        scene, accel, at.reference_toward(wi), at.ray_toward(wi), true,
        numbers.stream(i, path_dimension::own).fork(vertex), counts.scattered,
        [&](const Density<SolidAngle>& by_light) {
          return next.delta || n.points == 0
                     ? 1.0f
                     : power_weight(float(n.directions), next.density, float(n.points), by_light);
        },
        [&]([[maybe_unused]] bool meets, [[maybe_unused]] const Spectrum<float>& radiance, [[maybe_unused]] U number,
            [[maybe_unused]] Technique technique) {
          if constexpr (Tally::records)
            tally.template add<F>(meets, radiance * weight * way.share, {depth + 1, number, technique});
        });
    Spectrum<float> radiance = there.emitted;
    if (there.found)
      radiance += there.left * reflected(there, depth + 1, vertex,
                                         {way.throughput * weight * there.left * gray(float(n.directions)),
                                          way.share * weight * there.left});
    return weight * radiance;
  }

  void count_ray(U depth) { ++counts.by_depth[std::min<std::size_t>(depth, counts.by_depth.size() - 1)]; }
};

}  // namespace

template <class Tally>
RayCounts DistributionIntegrator::trace_with(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const {
  FirstHits<F> first_hits(scene_, accel_, pass, out, tally);
  RayCounts counts;
  counts.camera = first_hits.rays();
  counts.by_depth[0] = counts.camera;
  PathState<F> path{};
  const U first = path_dimension::first_vertex;
  while (first_hits.refill(path, false)) {
    const auto sampler = numbers_of(pass.points, path);
    const NextVertex<F> at = first_vertex<F>(scene_, accel_, path, true, sampler.stream(first + path_dimension::own),
                                             counts, seen_directly(path, tally));
    Spectrum<float> radiance = at.emitted;
    if (at.found) {
      Tree<Tally> tree{scene_, accel_, settings_, pass, {path.x, path.y, path.index}, counts, tally};
      radiance += at.left * tree.reflected(at, 0, 0, {gray(1.0f), at.left * path.weight});
      write_features(at, sampler, path, out);
    }
    out[path.output].radiance = to_rgb(radiance * path.weight);
    if constexpr (Tally::records) tally.finish(0, path.output, out[path.output]);
  }
  return counts;
}

template class LayeredIntegrator<DistributionIntegrator>;

}  // namespace montelux
