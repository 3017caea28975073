// Subpaths from the eye, whose vertices are connected with lights and with the subpaths from the lights.
#pragma once
#include "integrator/bidirectional/light_subpaths.h"
#include "integrator/first_vertex.h"
#include "integrator/photons/lookup.h"
#include "mc/roulette.h"
#include "transport/connection.h"
#include "transport/dimensions.h"
#include "transport/path_steps.h"

namespace montelux {

// Subpaths, one a lane, by the same plan of numbers as `path`. The strategies of each: it meets a light; a vertex is
// connected with a point of a light; a vertex is connected with each vertex of the pixel's own subpath from the lights,
// or merged with those of all such subpaths. `Correction` is AdjointCorrection, but in tests that plant a fault.
// `in_media`: the scene has participating media, in which vertices are connected but not merged.
template <class F, class Frame, class Correction = AdjointCorrection, bool in_media = false>
class EyeSubpaths {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  // `tally`: receives where the light comes from; null: nobody does.
  EyeSubpaths(const Frame& frame, const LightVertices& light, typename Frame::Tally* tally = nullptr)
      : frame_(frame), scene_(frame.scene), light_(light), tally_(tally) {
    if (frame.photons) photons_.emplace(*frame.photons, frame.kernel);
  }

  // One subpath from each pixel of a tile.
  RayCounts run(const PixelBounds& tile, std::span<PixelSample> out) {
    const TilePass pass{tile,         frame_.pass.points,    frame_.pass.shutter,
                        frame_.frame, frame_.shutter_sample, frame_.pass.grid};
    tile_ = tile;
    FirstHits<F> first_hits =
        tally_ ? FirstHits<F>(scene_, frame_.rays, pass, out, *tally_) : FirstHits<F>(scene_, frame_.rays, pass, out);
    counts_.camera += first_hits.rays();
    return run(first_hits, out);
  }
  // Those that `starts` has, by refill(path, on).
  template <class Starts>
  RayCounts run(Starts& starts, std::span<PixelSample> out) {
    PathState<F> path{};
    for (M on(false);;) {
      on = starts.refill(path, on);
      if (!any(on)) return counts_;
      on = step(path, on, out);
    }
  }

 private:
  // A vertex of the eye's subpath that is not a delta, as strategies see it.
  struct Here {
    const NextVertex<F>& at;
    M rough;
  };

  F weight_of_hit(const PathState<F>& path, Density<SolidAngle, F> sampled, const MetLight<F>& met) const {
    const M seen = path.depth == U(0u);
    if (!frame_.paths.connect) return select(only_smooth_, F(1.0f), F(0.0f));
    const M shared = met.on & !seen;
    if (!any(shared)) return F(1.0f);
    if (frame_.compensated) {
      const M beyond = frame_.compensated->template is_beyond<F>(met.number, shared);
      sampled = select(
          beyond, frame_.compensated->template sampling_density<F>(met.number, path.p, path.n, met.p, path.d, beyond),
          sampled);
    }
    const LightEnd<F> end = light_end<F>(frame_.path_lights(), {met.number, met.p, met.n, shared, met.passing}, -path.d,
                                         length_squared(met.p - path.p), sampled);
    return select(shared, frame_.weights.met(weights_, end, met.passing), F(1.0f));
  }

  // One vertex of every path; gives the lanes that continue.
  M step(PathState<F>& path, M on, std::span<PixelSample> out) {
    const auto sampler = frame_.eye_numbers(path);
    using Numbers = std::remove_cv_t<decltype(sampler)>;
    const U vertices = path.depth + U(2u);
    // Where a light that the path meets is wanted, and one that it samples.
    M wants_met(true), wants_sampled(true);
    if constexpr (!Frame::every_strategy)
      wants_met = frame_.wants(U(0u), vertices), wants_sampled = frame_.wants(U(1u), vertices);
    const U dimension = U(path_dimension::first_vertex) + path.depth * U(path_dimension::per_vertex);
    const M first = on & (path.depth == U(0u));
    only_smooth_ = only_smooth_ | first;
    F last_weight(1.0f);
    const auto weight = [&](const Density<SolidAngle, F>& sampled, const MetLight<F>& met) {
      return last_weight = weight_of_hit(path, sampled, met);
    };
    const auto sink = [&](const M& met, const Spectrum<F>& contribution, const U& number, Technique technique) {
      if (!tally_) return;
      const F share = select(number < U(scene_.lights.count()), last_weight, F(1.0f));
      tally_->template add<F>(met, path.throughput * contribution * path.weight,
                              {path.depth, number, technique, U(0u), false, share});
    };
    const auto sink_of_met = [&](const M& met, const auto&... light) { sink(met & wants_met, light...); };
    const auto arrive_by = [&](const auto& distances) {
      return arrive_path<F>(scene_, frame_.rays, path, on, wants_met,
                            sampler.stream(dimension + U(path_dimension::own)), counts_.scattered, weight, sink_of_met,
                            distances);
    };
    NextVertex<F> at = [&] {
      if constexpr (in_media)
        return arrive_by(
            MediumDistances<F, Numbers>{sampler, dimension + U(path_dimension::distance), path.throughput});
      else
        return arrive_by(NoDistances{});
    }();
    weigh_arrival(path, at, sampler, first);

    M scatters = on & at.found;
    if (frame_.paths.max_depth) scatters = scatters & (path.depth < U(std::uint32_t(*frame_.paths.max_depth)));
    if constexpr (!Frame::every_strategy) scatters = scatters & frame_.visits(vertices);
    const Here here{at, M(scatters & !at.bsdf.is_delta)};

    // A point of a light, and a direction.
    const LightSet& lights = frame_.sampled_lights();
    const ReferencePoint<F> from = at.reference();
    const M wants_light = here.rough & M(frame_.paths.connect && frame_.by_power != nullptr) & wants_sampled;
    const LightChoice<F> choice = lights.template choose<F>(
        from.p, from.n, sampler.get1(dimension + U(path_dimension::light_choice)), wants_light);
    const LightPointDraw<F> draw = lights.template draw_light_point<F>(
        choice.light, from.p, from.n, sampler.get2(dimension + U(path_dimension::light_point)),
        wants_light & choice.valid);
    const LightPointView<F> view =
        lights.template view<F>(draw.point, from.p, from.n, wants_light & choice.valid & draw.valid);
    const Vec2<F> u = sampler.get2(dimension + U(path_dimension::direction));
    const Scattering<F> scattered = scatter_at<F, in_media>(
        scene_, at,
        {at.wo, at.bsdf.frame.to_local(view.wi), view.valid, sampler.get1(dimension + U(path_dimension::lobe)), u},
        scatters);
    const BsdfSample<F>& next = scattered.next;
    if (const M shown = is_shown(path, M(on & at.found), scatters); any(shown))
      write_features(at, albedo_of(at, next, u, M(scatters & shown)), path, shown, out);
    if (any(view.valid)) connect_light(path, here, draw, choice.mass * draw.density, view, scattered.toward_light);
    if (frame_.paths.connect && frame_.by_power) connect_subpath(path, here);
    if (photons_) merge(path, at, here.rough & !at.in_medium);

    // Scatter; roulette.
    M moves = scatters & next.valid;
    if constexpr (!Frame::every_strategy) moves = moves & frame_.continues_from_eye(vertices, moves);
    moves = scatter_path(path, next, moves);
    const M plays = moves & (path.depth > U(std::uint32_t(frame_.paths.roulette_depth)));
    moves = survive_roulette(path, select(plays, survival_by_throughput(path), F(1.0f)),
                             sampler.get1(dimension + U(path_dimension::roulette)), moves);
    const Vec3<F> wi = at.bsdf.frame.to_world(next.wi);
    const BothDensities<F> both = densities(at, next.wi, next.density, M(moves & !next.delta));
    const PartialWeights<F> onward =
        frame_.weights.scatter(weights_, both, area_cosine<F, in_media>(at, wi), next.delta);
    weights_ = select_weights(moves, onward, weights_);
    only_smooth_ = only_smooth_ & (next.delta | !moves);
    leave_vertex(path, at, wi, next, moves, M(false));

    // The next vertex, or the sky.
    const M ended = on & !trace_on<F, in_media>(scene_, frame_.rays, path, moves, sees_next(vertices),
                                                counts_.scattered, weight, sink);
    const Spectrum<F> radiance = path.radiance * path.weight;
    for_each_lane(ended, [&](int k) {
      PixelSample& sample = out[lane(path.output, k)];
      sample.radiance = to_rgb(lane(radiance, k));
      if (tally_) tally_->finish(k, lane(path.output, k), sample);
    });
    return on & !ended;
  }

  // Adds light, its weight included, to the path and, with origin(), to the layers.
  template <class Origin>
  void add_light(PathState<F>& path, M on, const Spectrum<F>& contribution, Origin origin) {
    path.radiance += select(on, contribution, gray(F(0.0f)));
    if (tally_) tally_->template add<F>(on, contribution * path.weight, origin());
  }

  // Whether a light that is met by the vertex after this one is wanted.
  M sees_next([[maybe_unused]] const U& vertices) const {
    if constexpr (Frame::every_strategy)
      return M(true);
    else
      return frame_.wants(U(0u), vertices + U(1u));
  }
  template <class Numbers>
  void weigh_arrival(const PathState<F>& path, const NextVertex<F>& at, const Numbers& sampler, M first) {
    const F cos = area_cosine<F, in_media>(at, at.d);
    weights_ = frame_.weights.arrive(weights_, length_squared(at.x.point.p - path.p), cos, at.passing);
    if (!any(first)) return;
    const LensConnection<F> lens = scene_.camera.toward(at.x.point.p, sampler.get2(U(path_dimension::lens)), path.time);
    weights_ = select_weights(first, frame_.weights.first_from_lens(lens.across, cos, frame_.splat_paths(), at.passing),
                              weights_);
  }
  // Of the local wi, drawn with that density, and of the direction in which the path came, drawn from wi.
  BothDensities<F> densities(const NextVertex<F>& at, const Vec3<F>& wi, Density<SolidAngle, F> forward, M on) const {
    if (!any(on)) return {forward, {F(0.0f)}, !at.in_medium};
    return {forward, evaluate_at<F, in_media>(scene_, at, wi, at.wo, at.context, on).density, !at.in_medium};
  }
  Arriving<F> arriving(const NextVertex<F>& at, const Vec3<F>& wi, F distance, M on, std::uint32_t stream) {
    return arriving_from<F, in_media>(scene_, frame_.rays, at, wi, distance, on, at.context.random.fork(U(stream)),
                                      counts_.shadow);
  }

  // Next-event estimation.
  void connect_light(PathState<F>& path, const Here& here, const LightPointDraw<F>& draw,
                     const Density<SolidAngle, F>& density, const LightPointView<F>& view, const BsdfValue<F>& value) {
    const NextVertex<F>& at = here.at;
    const Spectrum<F> contribution = path.throughput * value.f_cos * view.radiance * (F(1.0f) / density);
    const M queries = view.valid & (max_component(contribution) > F(0.0f));
    if (!any(queries)) return;
    const Arriving<F> seen = arriving(at, view.wi, view.distance, queries, vertex_stream::shadow);
    if (!any(seen.on)) return;
    const BothDensities<F> both = densities(at, at.bsdf.frame.to_local(view.wi), value.density, seen.on);
    const LightEnd<F> end = light_end<F>(frame_.path_lights(), {draw.point.light, draw.point.p, draw.point.n, seen.on},
                                         -view.wi, view.distance * view.distance, density);
    const F weight =
        frame_.weights.light_sample(weights_, end, both, area_cosine<F, in_media>(at, view.wi), seen.passing);
    add_light(path, seen.on, contribution * seen.left * weight, [&] {
      return LightOrigin<F>{path.depth + U(1u), draw.point.light, Technique::light_sampling, U(1u), false, weight};
    });
  }

  // Every vertex of the pixel's subpath from the lights.
  void connect_subpath(PathState<F>& path, const Here& here) {
    U number = light_.template last_of<F>(path.output, here.rough);
    for (M left = here.rough & (number != U(0u)); any(left); left = left & (number != U(0u))) {
      const LightVertex<F> y = light_.template get<F>(number - U(1u), left);
      M on = left;
      if (frame_.paths.max_depth)
        on = on & (path.depth + y.events + U(2u) <= U(std::uint32_t(*frame_.paths.max_depth)));
      if constexpr (!Frame::every_strategy) on = on & frame_.wants(y.events + U(2u), path.depth + U(2u));
      if (any(on)) connect_vertex(path, here, y, on);
      number = select(left, y.before, U(0u));
    }
  }
  void connect_vertex(PathState<F>& path, const Here& here, const LightVertex<F>& y, M on) {
    const NextVertex<F>& at = here.at;
    const auto [wi, distance, squared] = line_to<F>(at.x.point.p, y.p);
    const Vec3<F> eye_wi = at.bsdf.frame.to_local(wi), light_wi = y.frame.to_local(-wi);
    BsdfContext<F> eye_context = at.context;
    eye_context.random = at.context.random.fork(U(vertex_stream::connection) + y.events);
    const BsdfValue<F> eye = evaluate_at<F, in_media>(scene_, at, at.wo, eye_wi, eye_context, on);
    on = on & !is_black(eye.f_cos);
    if (!any(on)) return;
    const BsdfContext<F> light_context{TransportMode::importance, y.random, on};
    const BsdfValue<F> light = evaluate_at<F, in_media>(scene_, y, y.wo, light_wi, light_context, on);
    const F ng_out = dot(y.ng, -wi), ng_in = -dot(y.ng, y.frame.to_world(y.wo));
    F correction = Correction()(y.wo, ng_in, light_wi, ng_out), cos_light = abs(ng_out);
    M y_in_medium(false);
    if constexpr (in_media) {
      y_in_medium = y.in_medium();
      correction = select(y_in_medium, F(1.0f), correction), cos_light = select(y_in_medium, F(1.0f), cos_light);
    }
    const Spectrum<F> value = path.throughput * eye.f_cos * y.flux * light.f_cos * (correction / squared);
    on = on & (max_component(value) > F(0.0f));
    if (!any(on)) return;
    const Arriving<F> seen = arriving(at, wi, distance, on, vertex_stream::connection);
    on = seen.on;
    if (!any(on)) return;
    const BothDensities<F> at_eye = densities(at, eye_wi, eye.density, on);
    const BothDensities<F> at_light{
        light.density, evaluate_at<F, in_media>(scene_, y, light_wi, y.wo, light_context, on).density, !y_in_medium};
    const F weight = frame_.weights.connection(weights_, at_eye, area_cosine<F, in_media>(at, wi), y.weights, at_light,
                                               cos_light, squared, seen.passing);
    add_light(path, on, value * seen.left * weight, [&] {
      return LightOrigin<F>{path.depth + y.events + U(2u),
                            frame_.template light_of_pair<F>(tile_, path.output),
                            Technique::light_sampling,
                            y.events + U(2u),
                            false,
                            weight};
    });
  }

  // Vertices of all subpaths from the lights that lie within the radius.
  void merge(PathState<F>& path, const NextVertex<F>& at, M on) {
    if (!any(on)) return;
    const U room = U(frame_.paths.max_depth ? std::uint32_t(*frame_.paths.max_depth) - 1u : 0x7fffffffu) - path.depth;
    const auto* words = reinterpret_cast<const float*>(frame_.photons->weights());
    const auto weight = [&](const FoundPhoton<F>& photon, M counted) {
      counted = counted & (photon.events <= room);
      const U word = photon.number * U(std::uint32_t(sizeof(PhotonWeights) / 4));
      const PartialWeights<F> y{gather(words, word), F(0.0f), gather(words + 1, word)};
      const BothDensities<F> both = densities(at, photon.wi, photon.density, counted);
      return select(counted, frame_.weights.merging(weights_, y, both), F(0.0f));
    };
    const auto to_layers = [&](const FoundPhoton<F>& photon, M counted, const Spectrum<F>& merged, const F& share) {
      const U light_number = gather(frame_.light_of_path, gather(frame_.photons->paths(), photon.number));
      tally_->template add<F>(counted, path.throughput * merged * path.weight,
                              {path.depth + photon.events + U(1u), light_number, Technique::light_sampling,
                               photon.events + U(2u), true, share});
    };
    const GatheringSurface<F> place{at, at.context};
    const Spectrum<F> contribution = tally_ ? photons_->template radiance<F>(place, on, weight, to_layers)
                                            : photons_->template radiance<F>(place, on, weight, NoSink{});
    path.radiance += select(on, path.throughput * contribution, gray(F(0.0f)));
  }

  const Frame& frame_;
  const Scene& scene_;
  const LightVertices& light_;
  typename Frame::Tally* tally_;
  PixelBounds tile_{};
  std::optional<PhotonLookup> photons_;
  // Of the paths at hand: the weights so far, and whether all events were deltas.
  PartialWeights<F> weights_{F(0.0f), F(0.0f), F(0.0f)};
  M only_smooth_{false};
  RayCounts counts_;
};

}  // namespace montelux
