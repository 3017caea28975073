// Paths from the eye to the surfaces where they gather photons, for one path (F = float) and for a pack of them.
#pragma once
#include "integrator/first_vertex.h"
#include "integrator/path/first_hits.h"
#include "integrator/path/light_weights.h"
#include "integrator/photons/lookup.h"
#include "transport/visibility.h"

namespace montelux {

// Every pixel's path, by mirrors, glass and glossy directions to the surfaces where it gathers photons.
//
// At a rough surface the path itself continues in directions that its BSDF samples with a density above `glossy`;
// photons represent the others. A path that leaves in one of the others ends at the next surface: it only looks for
// emission there, which next-event estimation shares with it. So every light path counts once: its last vertices before
// the eye are those of the path, the others a photon's.
template <class F, class Rays>
class PhotonGathering {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  // What is referred to must outlive this.
  PhotonGathering(const Scene& scene, const Rays& rays, const GatheringRules& rules, const PhotonLookup& photons)
      : scene_(scene), rays_(rays), rules_(rules), mis_{rules.nee, PathMis::power}, photons_(photons) {}

  RayCounts run(const TilePass& pass, std::span<PixelSample> out) {
    FirstHits<F> first_hits(scene_, rays_, pass, out);
    counts_.camera += first_hits.rays();
    PathState<F> path{};
    M ends(false);
    for (M on(false);;) {
      const M before = on;
      on = first_hits.refill(path, on);
      if (!any(on)) return counts_;
      ends = ends & before;
      on = step(pass, path, on, ends, out);
    }
  }

 private:
  // One vertex of every path; gives the lanes that continue. `ends`: those that only look for emission.
  M step(const TilePass& pass, PathState<F>& path, M on, M& ends, std::span<PixelSample> out) {
    const Sampler<F> sampler(pass.points, path.x, path.y, path.index);
    const U dimension = U(path_dimension::first_vertex) + path.depth * U(path_dimension::per_vertex);
    const auto weight = [&](const Density<SolidAngle, F>& by_light) {
      return weight_of_light_hit(mis_, path.density, by_delta(path), by_light);
    };
    const NextVertex<F> at =
        follow_ray<F>(scene_, rays_, {path.p, path.n, path.media}, {path.o, path.d, F(ray_infinity), path.time},
                      path.hit, on, sampler.stream(dimension + U(path_dimension::own)), counts_.scattered, weight);
    path.radiance += select(on, path.throughput * at.light, gray(F(0.0f)));
    path.throughput = select(on, path.throughput * at.left, path.throughput);
    M scatters = on & at.found & !ends;
    if (rules_.max_depth) scatters = scatters & (path.depth < U(std::uint32_t(*rules_.max_depth)));
    const M rough = scatters & !at.bsdf.is_delta;
    BsdfContext<F> context = at.context;
    context.densities = Densities::exact;

    // A point of a light, and a direction.
    const M wants_light = rough & M(rules_.nee);
    const ReferencePoint<F> from = at.reference();
    const LightSample<F> light =
        scene_.lights.template sample<F>(from.p, from.n, sampler.get1(dimension + U(path_dimension::light_choice)),
                                         sampler.get2(dimension + U(path_dimension::light_point)), wants_light);
    const M queries = wants_light & light.valid;
    const Scattering<F> scattered =
        scatter<F>(at.bsdf.lanes(scatters),
                   {at.wo, at.bsdf.frame.to_local(light.wi), queries, sampler.get1(dimension + U(path_dimension::lobe)),
                    sampler.get2(dimension + U(path_dimension::direction))},
                   context);
    const BsdfSample<F>& next = scattered.next;
    if (const M first = on & (path.depth == U(0u)) & at.found; any(first))
      write_features(at, select(scatters & next.valid, next.weight, gray(F(0.0f))), path, first, out);
    if (any(queries)) add_direct(path, at, light, scattered.toward_light, queries);
    if (any(rough)) {
      const U room = U(rules_.max_depth ? std::uint32_t(*rules_.max_depth) - 1u : 0x7fffffffu) - path.depth;
      const Spectrum<F> gathered =
          photons_.template radiance<F>(at, context, rough, [&](const FoundPhoton<F>& photon, M) {
            return select((photon.density.value <= F(rules_.glossy)) & (photon.events <= room), F(1.0f), F(0.0f));
          });
      path.radiance += select(rough, path.throughput * gathered, gray(F(0.0f)));
    }

    // Scatter; roulette.
    M moves = scatters & next.valid;
    const M broken = moves & !is_finite(max_component(next.weight));
    if (any(broken)) path.radiance += select(broken, next.weight, gray(F(0.0f)));
    moves = moves & !broken;
    const M follows = next.delta | (next.density.value > F(rules_.glossy));
    if (!rules_.nee) moves = moves & follows;
    path.throughput = select(moves, path.throughput * next.weight, path.throughput);
    path.eta_scale = select(moves, path.eta_scale * next.eta_scale, path.eta_scale);
    path.depth = path.depth + select(moves, U(1u), U(0u));
    const M plays = moves & (path.depth > U(std::uint32_t(rules_.roulette_depth)));
    const Roulette<F> survival = roulette(select(plays, survival_by_throughput(path), F(1.0f)),
                                          sampler.get1(dimension + U(path_dimension::roulette)));
    moves = moves & survival.survives;
    path.throughput = select(moves, path.throughput * survival.weight, path.throughput);
    ends = (moves & !follows) | (ends & !moves);
    const Vec3<F> wi = at.bsdf.frame.to_world(next.wi);
    path.media = select_media<F>(moves, at.media_toward(wi), path.media);
    path.p = select(moves, at.x.point.p, path.p), path.n = select(moves, at.bsdf.light_normal, path.n);
    path.density.value = select(moves, next.density.value, path.density.value);
    path.by_delta = select(moves, select(next.delta, U(1u), U(0u)), path.by_delta);
    path.o = at.origin_toward(wi), path.d = wi;

    // The next vertex, or the sky.
    counts_.scattered += std::uint64_t(count(moves));
    const auto [found, hit] = rays_.template trace<F>({path.o, path.d, F(ray_infinity), path.time}, moves);
    path.hit = hit;
    if (const M escapes = moves & !found; any(escapes))
      path.radiance += path.throughput *
                       sky_light<F>(scene_.lights, {path.p, path.n, path.media}, path.d, escapes, weight, NoSink{});
    const M ended = on & !(moves & found);
    const Spectrum<F> radiance = path.radiance * path.weight;
    for_each_lane(ended, [&](int k) { out[lane(path.slot, k)].radiance = to_rgb(lane(radiance, k)); });
    return on & !ended;
  }

  void add_direct(PathState<F>& path, const NextVertex<F>& at, const LightSample<F>& light, const BsdfValue<F>& value,
                  M queries) {
    const F share = select(light.delta, F(1.0f), weight_of_light_sample(mis_, light.density, value.density));
    const Spectrum<F> direct = path.throughput * value.f_cos * light.radiance *
                               at.left_of_light(light.wi, light.distance) * (share / light.density.value);
    const M shadow = queries & (max_component(direct) > F(0.0f));
    if (!any(shadow)) return;
    const M lit = unblocked<F>(rays_, at.shadow_ray_to(light.wi, light.distance), shadow, counts_.shadow);
    path.radiance += select(lit, direct, gray(F(0.0f)));
  }

  const Scene& scene_;
  const Rays& rays_;
  const GatheringRules rules_;
  const LightWeights mis_;
  PhotonLookup photons_;
  RayCounts counts_;
};

}  // namespace montelux
