// Paths from the eye to the surfaces, and the events in media, where they gather photons, for one path (F = float) and
// for a pack of them.
#pragma once
#include <array>
#include <optional>

#include "integrator/first_vertex.h"
#include "integrator/path/first_hits.h"
#include "integrator/path/light_weights.h"
#include "integrator/path/segment_light.h"
#include "integrator/photons/gathering_tallies.h"
#include "integrator/photons/lookup.h"
#include "math/lane_queue.h"
#include "transport/connection.h"
#include "transport/dimensions.h"
#include "transport/path_steps.h"

namespace montelux {

// A gather ray on its way, one a lane: words alone, as set_lane_words takes them.
template <class F>
struct GatherRay {
  PathState<F> path;
  Uint<F> followed;  // events since it left the surface in view
  Uint<F> number;    // of its result
};

// Every pixel's path, by mirrors, glass and glossy directions to the surfaces where it gathers photons.
//
// At a rough surface the path itself continues in directions that its BSDF samples with a density above `glossy`, those
// that are followed; photons represent the others. So every light path counts once: its last vertices before the eye
// are those of the path, the others a photon's.
//
// Without gather rays a path that leaves in one of the other directions ends at the next surface: it only looks for
// emission there, which next-event estimation shares with it.
//
// With gather rays the photons of the surface in view are those of caustics alone, whose events before were all in
// directions that are followed. Gather rays leave in the other directions, with the same part in the direct light, and
// continue in directions that are followed. At their rough surfaces the photons of a second map, which holds all of
// them, represent the light in all other directions. Light that they meet after an event of their own is that of a
// caustic, and not theirs.
//
// In participating media (`in_media`) the same holds at events in media, where photons of such events are gathered.
// `Segments` is RaySegmentLights, except in tests that plant a fault.
template <class F, class Rays, bool in_media = false, template <class, class, class> class Segments = RaySegmentLights>
class PhotonGathering {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  // What is referred to must outlive this. `beyond`: the photons that gather rays look up. `tallies`: receive where the
  // light comes from, the second one that of gather rays; null: nobody does.
  PhotonGathering(const Scene& scene, const Rays& rays, const GatheringRules& rules, const PhotonLookups& in_view,
                  const std::optional<PhotonLookups>& beyond = {}, std::array<LayerTally, 2>* tallies = nullptr)
      : scene_(scene),
        rays_(rays),
        rules_(rules),
        mis_{rules.nee, PathMis::power},
        in_view_(in_view),
        beyond_(beyond),
        tallies_(tallies) {}

  RayCounts run(const TilePass& pass, std::span<PixelSample> out) {
    FirstHits<F> first_hits =
        tallies_ ? FirstHits<F>(scene_, rays_, pass, out, (*tallies_)[0]) : FirstHits<F>(scene_, rays_, pass, out);
    counts_.camera += first_hits.rays();
    gathered_.assign(beyond_ ? out.size() : 0, gray(0.0f));
    PathState<F> path{};
    M ends(false);
    for (M on(false);;) {
      const M before = on;
      on = first_hits.refill(path, on);
      if (!any(on)) break;
      ends = ends & before;
      on = step(pass, path, on, ends, out);
      if (waiting_.size() >= max_waiting) gather(pass);
    }
    gather(pass);
    for (std::size_t i = 0; i < gathered_.size(); ++i) {
      out[i].radiance += to_rgb(gathered_[i]);
      if (tallies_) (*tallies_)[0].settle(std::uint32_t(i), out[i]);
    }
    return counts_;
  }

 private:
  // Gather rays that wait for each other, to be followed as full packs.
  static constexpr std::size_t max_waiting = 4096;
  struct Gathered {
    std::uint32_t output;
    Spectrum<float> radiance;
  };

  // Where light is added to layers (null: nowhere), and the share of it that a pixel receives.
  struct Layers {
    LayerTally* tally;
    float share;
  };
  Layers of_paths() const { return {tallies_ ? &(*tallies_)[0] : nullptr, 1}; }
  Layers of_gather_rays() const {
    return {tallies_ ? &(*tallies_)[1] : nullptr, 1 / float(std::max(rules_.gather_rays, 1))};
  }
  static void record(const Layers& to, M on, const PathState<F>& path, const Spectrum<F>& contribution,
                     const LightOrigin<F>& from) {
    to.tally->template add<F>(on, path.throughput * contribution * (path.weight * F(to.share)), from);
  }

  // Their points: as many for each pixel of the pass as it has gather rays.
  static PointSet gather_points(const TilePass& pass, int rays) {
    PointSet points = pass.points;
    points.samples_per_pass *= std::uint32_t(rays);
    points.seed = mix_bits(points.seed ^ 0xa54ff53au);
    return points;
  }
  auto gather_numbers(const TilePass& pass, const PathState<F>& path, const U& ray) const {
    const U index = path.index * U(std::uint32_t(rules_.gather_rays)) + ray;
    return numbers_of<F>(gather_points(pass, rules_.gather_rays), PathSite<F>{path.x, path.y, index});
  }
  struct NoSegments {
    MONTELUX_INLINE void begin(const auto&...) const {}
  };
  static U dimension_of(const PathState<F>& path) {
    return U(path_dimension::first_vertex) + path.depth * U(path_dimension::per_vertex);
  }
  // For light that a ray meets.
  static auto sink_for(const PathState<F>& path, const Layers& layers) {
    return [&path, layers](const M& met, const Spectrum<F>& contribution, const U& number, Technique technique) {
      if (layers.tally) record(layers, met, path, contribution, {path.depth, number, technique});
    };
  }
  // The vertex that a path has met, with the light met on the way. In media `segments` receives its segments, as
  // ReportedDistances has it.
  template <class Weight, NumberSource<F> Numbers, class Receiver>
  NextVertex<F> arrive(PathState<F>& path, M on, const Numbers& numbers, Weight weight, const Layers& layers,
                       Receiver& segments) {
    const U dimension = dimension_of(path);
    const auto arrive_by = [&](const auto& distances) {
      return arrive_path<F>(scene_, rays_, path, on, on, numbers.stream(dimension + U(path_dimension::own)),
                            counts_.scattered, weight, sink_for(path, layers), distances);
    };
    if constexpr (in_media)
      return arrive_by(ReportedDistances<F, Numbers, Receiver>{
          {numbers, dimension + U(path_dimension::distance), path.throughput}, segments});
    else
      return arrive_by(NoDistances{});
  }
  M may_scatter(const PathState<F>& path) const {
    return rules_.max_depth ? path.depth < U(std::uint32_t(*rules_.max_depth)) : M(true);
  }
  // A direction in which the vertex scatters, by the numbers of a context.
  BsdfSample<F> sampled(const NextVertex<F>& at, const F& u_lobe, const Vec2<F>& u, const BsdfContext<F>& context,
                        M on) const {
    if constexpr (in_media) {
      NextVertex<F> own = at;
      own.context = context;
      return scatter_at<F, true>(scene_, own, {at.wo, at.wo, M(false), u_lobe, u}, on).next;
    } else {
      return sample<F>(at.bsdf.lanes(on), at.wo, {u_lobe, u.x, u.y}, context);
    }
  }
  // Whether a sampled direction is followed by the path from the eye.
  M follows(const BsdfSample<F>& next) const { return next.delta | (next.density.value > F(rules_.glossy)); }
  auto weight_for(const PathState<F>& path) const {
    return [this, &path](const Density<SolidAngle, F>& by_light) {
      return weight_of_light_hit(mis_, path.density, by_delta(path), by_light, M(false));
    };
  }
  // The light that photons scatter toward the path.
  void add_photons(PathState<F>& path, PhotonLookups& maps, const NextVertex<F>& at, M rough,
                   const Layers& layers) const {
    add_photons_of(path, maps.surfaces, GatheringSurface<F>{at, at.context}, rough & !at.in_medium, layers);
    if constexpr (in_media)
      if (const M events = rough & at.in_medium; any(events))
        add_photons_of(path, *maps.media, GatheringEvent<F>{scene_, at}, events, layers);
  }
  template <class Place>
  void add_photons_of(PathState<F>& path, PhotonLookup& map, const Place& place, M on, const Layers& layers) const {
    const U room = U(rules_.max_depth ? std::uint32_t(*rules_.max_depth) - 1u : 0x7fffffffu) - path.depth;
    const PhotonRules<F> rules{rules_.glossy, room};
    const auto to_layers = [&](const FoundPhoton<F>& photon, const M& counted, const Spectrum<F>& contribution,
                               const F&) {
      record(layers, counted, path, contribution,
             {path.depth + photon.events + U(1u), map.template light_of<F>(photon.number), Technique::light_sampling,
              photon.events + U(2u), true});
    };
    const Spectrum<F> radiance = layers.tally ? map.template radiance_by_rules<F>(place, on, rules, to_layers)
                                              : map.template radiance_by_rules<F>(place, on, rules);
    path.radiance += select(on, path.throughput * radiance, gray(F(0.0f)));
  }
  // Scatters paths, with roulette, and traces them to the next surface or the sky; gives those that have met a surface,
  // in media all that are on their way.
  template <class Weight>
  M leave(PathState<F>& path, const NextVertex<F>& at, const BsdfSample<F>& next, M moves,
          const NumberSource<F> auto& numbers, Weight weight, const Layers& layers) {
    const U dimension = dimension_of(path);
    moves = scatter_path(path, next, moves);
    const M plays = moves & (path.depth > U(std::uint32_t(rules_.roulette_depth)));
    moves = survive_roulette(path, select(plays, survival_by_throughput(path), F(1.0f)),
                             numbers.get1(dimension + U(path_dimension::roulette)), moves);
    leave_vertex(path, at, at.bsdf.frame.to_world(next.wi), next, moves, M(false));
    return trace_on<F, in_media>(scene_, rays_, path, moves, moves, counts_.scattered, weight, sink_for(path, layers));
  }

  // One vertex of every path; gives the lanes that continue. `ends`: those that only look for emission.
  M step(const TilePass& pass, PathState<F>& path, M on, M& ends, std::span<PixelSample> out) {
    const auto sampler = numbers_of(pass.points, path);
    const U dimension = dimension_of(path);
    const Layers layers = of_paths();
    const M may = may_scatter(path) & !ends;
    Spectrum<F> along = gray(F(0.0f));  // what events on the segments scatter: it is not directly visible
    const auto add_segment_light = [&](const typename SegmentLight<F>::Sample& also) {
      along += select(also.on, also.contribution, gray(F(0.0f)));
      if (layers.tally)
        layers.tally->template add<F>(also.on, also.contribution * path.weight,
                                      {path.depth + U(1u), also.light, Technique::light_sampling});
    };
    Segments<F, Rays, decltype(add_segment_light)> segments(scene_, rays_, on & may & M(rules_.nee), counts_.shadow,
                                                            add_segment_light);
    NextVertex<F> at = arrive(path, on, sampler, weight_for(path), layers, segments);
    const M scatters = on & at.found & may;
    const M rough = scatters & !at.bsdf.is_delta;

    // A point of a light, and a direction.
    const M wants_light = rough & M(rules_.nee);
    const ReferencePoint<F> from = at.reference();
    const F u_choice = sampler.get1(dimension + U(path_dimension::light_choice));
    const LightSample<F> light = scene_.lights.template sample<F>(
        from.p, from.n, u_choice, sampler.get2(dimension + U(path_dimension::light_point)), wants_light);
    const M queries = wants_light & light.valid;
    const Vec2<F> u = sampler.get2(dimension + U(path_dimension::direction));
    const Scattering<F> scattered = scatter_at<F, in_media>(
        scene_, at,
        {at.wo, at.bsdf.frame.to_local(light.wi), queries, sampler.get1(dimension + U(path_dimension::lobe)), u},
        scatters);
    const BsdfSample<F>& next = scattered.next;
    if (const M shown = is_shown(path, M(on & at.found), scatters); any(shown))
      write_features(at, albedo_of(at, next, u, M(scatters & shown)), path, shown, out);
    path.radiance += along;
    if (any(queries)) {
      F share(1.0f);
      if constexpr (in_media)
        share = segments.share(at.x.point.p, at.x.distance, light, u_choice, M(queries & at.in_medium));
      add_direct(path, at, {light, u_choice, share, queries}, scattered.toward_light);
    }
    if (any(rough)) {
      add_photons(path, in_view_, at, rough, layers);
      if (beyond_) send_gather_rays(pass, path, at, rough);
    }

    M moves = scatters & next.valid;
    const M followed = follows(next);
    if (!rules_.nee || beyond_) moves = moves & followed;
    const M left = leave(path, at, next, moves, sampler, weight_for(path), layers);
    ends = left & !followed;
    const M ended = on & !left;
    const Spectrum<F> radiance = path.radiance * path.weight;
    for_each_lane(ended, [&](int k) {
      PixelSample& sample = out[lane(path.output, k)];
      sample.radiance = to_rgb(lane(radiance, k));
      if (layers.tally) layers.tally->finish(k, lane(path.output, k), sample);
    });
    return left;
  }

  // A point of a light, the number that chose the light, and the share of this sample in a delta light.
  struct DrawnLight {
    const LightSample<F>& sample;
    F u_choice;
    F share_of_delta;
    M on;
  };
  void add_direct(PathState<F>& path, const NextVertex<F>& at, const DrawnLight& drawn, const BsdfValue<F>& value) {
    const LightSample<F>& light = drawn.sample;
    const F share =
        select(light.delta, drawn.share_of_delta, weight_of_light_sample(mis_, light.density, value.density, M(false)));
    const Spectrum<F> direct = path.throughput * value.f_cos * light.radiance * (share / light.density);
    const M shadow = drawn.on & (max_component(direct) > F(0.0f));
    if (!any(shadow)) return;
    const Arriving<F> seen =
        arriving_from<F, in_media, false>(scene_, rays_, at, light.wi, light.distance, shadow,
                                          at.context.random.fork(U(vertex_stream::shadow)), counts_.shadow);
    const Spectrum<F> arrives = direct * seen.left;
    path.radiance += select(seen.on, arrives, gray(F(0.0f)));
    if (!tallies_) return;
    const ReferencePoint<F> from = at.reference();
    const U number = scene_.lights.template choose<F>(from.p, from.n, drawn.u_choice, drawn.on).light;
    of_paths().tally->template add<F>(seen.on, arrives * path.weight,
                                      {path.depth + U(1u), number, Technique::light_sampling});
  }

  // Light that a gather ray meets counts before its first event alone, as direct light of the surface in view.
  auto weight_of_gather_ray(const GatherRay<F>& ray) const {
    return [this, weight = weight_for(ray.path), &ray](const Density<SolidAngle, F>& by_light) {
      return select((ray.followed == U(0u)) & M(rules_.nee), weight(by_light), F(0.0f));
    };
  }
  // The gather rays of surfaces in view, up to the surfaces that they meet, where they wait. Results of one pixel are
  // in the order of its path, so that their sum has the same bits whatever the lanes.
  void send_gather_rays(const TilePass& pass, const PathState<F>& path, const NextVertex<F>& at, M rough) {
    const U dimension = dimension_of(path);
    for (int i = 0; i < rules_.gather_rays; ++i) {
      const auto numbers = gather_numbers(pass, path, U(std::uint32_t(i)));
      BsdfContext<F> own = at.context;
      own.random = at.context.random.fork(U(vertex_stream::gather_ray + std::uint32_t(i)));
      const Vec2<F> u = numbers.get2(dimension + U(path_dimension::direction));
      const BsdfSample<F> next = sampled(at, numbers.get1(dimension + U(path_dimension::lobe)), u, own, rough);
      const M sent = rough & next.valid & !follows(next);
      if (!any(sent)) continue;
      GatherRay<F> ray{path, U(0u), U(0u)};
      ray.path.radiance = gray(F(0.0f));
      const M met = leave(ray.path, at, next, sent, numbers, weight_of_gather_ray(ray), of_gather_rays());
      for_each_lane(sent, [&](int k) {
        set_lane(ray.number, k, std::uint32_t(results_.size()));
        results_.push_back({lane(path.output, k), lane(ray.path.radiance, k) * lane(path.weight, k)});
        finish_gather_ray(k, lane(path.output, k));
      });
      // The number of the ray stands where the loop over packs finds it with the pixel's point.
      ray.path.output = U(std::uint32_t(i));
      waiting_.add(ray, met);
    }
  }
  // What the ray of lane k has found so far joins the layers of its pixel.
  void finish_gather_ray(int k, std::uint32_t output) {
    PixelSample sample;
    if (tallies_) (*tallies_)[1].finish(k, output, sample);
  }
  // Follows the gather rays that wait, and adds what they find to their pixels.
  void gather(const TilePass& pass) {
    GatherRay<F> ray{};
    for (M on(false);;) {
      on = on | waiting_.fill(ray, on);
      if (!any(on)) break;
      const M left = gather_step(pass, ray, on);
      const Spectrum<F> radiance = ray.path.radiance * ray.path.weight;
      for_each_lane(on & !left, [&](int k) {
        Gathered& result = results_[lane(ray.number, k)];
        result.radiance = lane(radiance, k);
        finish_gather_ray(k, result.output);
      });
      on = left;
    }
    const float share = 1 / float(std::max(rules_.gather_rays, 1));
    for (const Gathered& one : results_) gathered_[one.output] += one.radiance * share;
    results_.clear();
  }
  // One vertex of every gather ray; gives the lanes that continue.
  M gather_step(const TilePass& pass, GatherRay<F>& ray, M on) {
    PathState<F>& path = ray.path;
    const auto numbers = gather_numbers(pass, path, path.output);
    const U dimension = dimension_of(path);
    NoSegments unreported;  // photons represent what events on a gather ray receive
    NextVertex<F> at = arrive(path, on, numbers, weight_of_gather_ray(ray), of_gather_rays(), unreported);
    const M scatters = on & at.found & may_scatter(path);
    const Vec2<F> u = numbers.get2(dimension + U(path_dimension::direction));
    const BsdfSample<F> next = sampled(at, numbers.get1(dimension + U(path_dimension::lobe)), u, at.context, scatters);
    if (const M rough = scatters & !at.bsdf.is_delta; any(rough))
      add_photons(path, *beyond_, at, rough, of_gather_rays());
    const M moves = scatters & next.valid & follows(next);
    ray.followed = ray.followed + select(moves, U(1u), U(0u));
    return leave(path, at, next, moves, numbers, weight_of_gather_ray(ray), of_gather_rays());
  }

  const Scene& scene_;
  const Rays& rays_;
  const GatheringRules rules_;
  const LightWeights mis_;
  PhotonLookups in_view_;
  std::optional<PhotonLookups> beyond_;
  std::array<LayerTally, 2>* const tallies_;
  LaneQueue<GatherRay, F> waiting_;
  std::vector<Gathered> results_;
  std::vector<Spectrum<float>> gathered_;  // by output
  RayCounts counts_;
};

}  // namespace montelux
