// What a pixel finds by itself behind its vertex: one path by BSDF sampling with next-event estimation at every further
// vertex, of whose ends one is kept in proportion to its contribution.
#pragma once

#include "integrator/path/loop.h"
#include "integrator/restir/path_shift.h"
#include "math/lane_queue.h"
#include "transport/next_vertex.h"

namespace montelux {

// A path on its way, with what it was joined to if it was; made of 32-bit words alone.
template <class F>
struct PathWalk {
  ReuseVertex<F> from;             // the vertex that the ray left
  Vec3<F> o, d;                    // the ray
  Hit<F> hit;                      // what it met,
  Uint<F> found;                   // if anything
  Spectrum<F> before;              // product of the events' weights up to `from`
  Spectrum<F> leaving;             // times f cos of the event there; black for a delta
  Spectrum<F> weight;              // times its weight
  Density<SolidAngle, F> density;  // of d at `from`, where it is not
  Uint<F> by_delta;                // 1: that of a delta
  F eta_scale;                     // as PathState has it
  F pixels;                        // squared distance of pixels, for Leg
  Uint<F> events;                  // up to d
  Uint<F> crossings;               // interfaces since the last event
  RandomStream<F> numbers;
  Spectrum<F> plain;    // light that cannot be shared
  Uint<F> joined;       // number of the event at the surface that the path was joined to; 0: not yet
  StoredSurface<F> at;  // that surface, the direction from there,
  Vec3<F> wi;
  Spectrum<F> until;  // what the path contributes for each unit of light along it,
  Spectrum<F> tail;   // and the weights of all events behind
  Uint<F> output;
};

// The walks of a tile: begin() for each pixel, then run().
template <class F, class Rays>
class PathCandidates {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  PathCandidates(const PathScene<Rays>& shared, const PathSettings& settings, RayCounts& counts)
      : shared_(shared), settings_(settings), counts_(counts) {}

  // The first event of the paths at `vertex`, whose ray has met `hit` where `found`.
  void begin(const ReuseVertex<F>& vertex, const PathEvent<F>& event, const RandomStream<F>& numbers,
             const PathState<F>& ray, M found, M on) {
    PathWalk<F> walk{};
    walk.from = vertex, walk.o = ray.o, walk.d = ray.d, walk.hit = ray.hit;
    walk.found = select(found, U(1u), U(0u)), walk.output = ray.output;
    walk.before = gray(F(1.0f)), walk.leaving = event.f_cos, walk.weight = event.weight;
    walk.density = event.density, walk.by_delta = select(event.delta, U(1u), U(0u)), walk.eta_scale = ray.eta_scale;
    walk.pixels = squared_distance_of_pixels(shared_.reuse, vertex);
    walk.events = U(1u), walk.crossings = U(0u), walk.joined = U(0u), walk.numbers = numbers;
    walk.plain = walk.until = walk.tail = gray(F(0.0f));
    walks_.add(walk, on);
  }

  // Calls done(output, reservoir, light of the pixel alone, mask) for every walk that has ended.
  template <class Done>
  void run(Done done) {
    M on(false);
    for (;;) {
      on = refill(on);
      if (!any(on)) return;
      const M ended = step(on);
      if (!any(ended)) continue;
      const F target = usable_weight(average(chosen_.value.contribution));
      const M found = ended & (chosen_.weight_sum > F(0.0f)) & (target > F(0.0f));
      const PathReservoir<F> reservoir{chosen_.value,
                                       select(found, usable_weight<F>(chosen_.weight_sum / target), F(0.0f)), F(1.0f),
                                       select(found, target, F(0.0f))};
      done(walk_.output, reservoir, walk_.from.throughput * walk_.plain, ended);
      on = on & !ended;
    }
  }

 private:
  M refill(M on) {
    const M fresh = walks_.fill(walk_, on);
    chosen_.weight_sum = select(fresh, F(0.0f), chosen_.weight_sum);
    return on | fresh;
  }

  // Light that a path meets.
  struct MetLights {
    PathCandidates& candidates;
    const EventNumbers<F>& numbers;

    void emitter(const EmitterOnRay<F>& met, M on) { candidates.meet_surface(met, on, numbers); }
    void sky(const SkyOnRay<F>& met, M on) { candidates.meet_sky(met.left, on, numbers); }
  };

  // One surface of every path, or the sky; gives the lanes that have ended.
  M step(M on) {
    PathWalk<F>& w = walk_;
    const EventNumbers<F> led_here(w.numbers, w.events - U(1u));
    RayProgress<F> way{{{w.o, w.d, F(ray_infinity), w.from.time}, w.hit, w.from.media_toward(shared_.scene.media, w.d)},
                       gray(F(1.0f)),
                       F(1.0f),
                       w.crossings};
    MetLights met{*this, led_here};
    const M left = on & (w.found == U(0u));
    if (any(left)) met.sky({way.segment.media.left(F(ray_infinity)), F(1.0f), w.crossings}, left);
    on = on & !left;
    if (!any(on)) return left;

    const SegmentEnd<F> end =
        end_segment<F>(shared_.scene, way, {on, M(true)}, led_here.surface().fork(w.crossings), met);
    const Vertex<F>& v = end.v;
    const ReuseVertex<F> vertex = vertex_behind<F>(w.from, v);
    absorb(way.left, on);

    const M scatters = on & !end.passes & (w.from.events + w.events < U(shared_.max_events));
    const Leg<F> leg = leg_between<F>(w.from.p, v.x, w.d, w.density, w.by_delta == U(0u), w.pixels);
    if (const M lit = scatters & !v.bsdf.is_delta; any(lit)) sample_light(vertex, leg, lit);
    const M continues = scatter(vertex, leg, scatters);

    // The next surface, or the sky.
    const M moves = continues | end.passes;
    w.o = select(moves, v.origin_toward(w.d), w.o);
    w.crossings = select(continues, U(0u), w.crossings + select(end.passes, U(1u), U(0u)));
    counts_.scattered += std::uint64_t(count(moves));
    const auto [found, hit] = shared_.rays.template trace<F>({w.o, w.d, F(ray_infinity), w.from.time}, moves);
    w.hit = hit, w.found = select(found, U(1u), U(0u));
    return left | (on & !moves);
  }

  // Multiplies the weights by the transmittance `left` of the last segment.
  void absorb(const Spectrum<F>& left, M on) {
    PathWalk<F>& w = walk_;
    w.weight = select(on, w.weight * left, w.weight), w.leaving = select(on, w.leaving * left, w.leaving);
    w.tail = select(on, w.tail * left, w.tail);
  }

  // ---- ends of the path

  void meet_surface(const EmitterOnRay<F>& emitter, M on, const EventNumbers<F>& numbers) {
    const PathWalk<F>& w = walk_;
    const SurfaceHit<F>& x = emitter.v.x;
    const U light = select(on, x.light - U(1u), U(0u));
    const LightHit<F> hit = emission_met<F>(shared_.lights, {w.from.p, w.from.light_normal}, x, w.d, on);
    const M shines = on & !is_black(hit.radiance);
    meet({shared_.lights.point_of_hit(light, x.point.p, x.point.ng, hit.radiance, shines), hit, emitter.left,
          emitter.passes},
         numbers.surface().fork(emitter.crossings).fork(U(vertex_stream::resampling)).at(U(0u)), shines);
  }
  void meet_sky(const Spectrum<F>& left, M on, const EventNumbers<F>& numbers) {
    const PathWalk<F>& w = walk_;
    // What a delta meets is found again as a whole. Choice 0 is that of next-event estimation where the event was.
    if (const M smooth = on & (w.by_delta != U(0u)); any(smooth)) {
      const LightHit<F> all{shared_.lights.template escaped_radiance<F>(w.d, smooth), {F(0.0f)}};
      meet({{}, all, left, M(false)}, numbers.choice(1), smooth);
    }
    const M spread = on & (w.by_delta == U(0u));
    std::uint32_t choice = 0;
    for_each_sky_light<F>(
        shared_.lights, {w.from.p, w.from.light_normal}, w.d, spread, [&](const LightHit<F>& sky, const U& number) {
          const LightPoint<F> point{w.d, w.d, sky.radiance, number, in_lanes<F>(LightPlace::infinite)};
          meet({point, sky, left, M(false)}, numbers.choice(++choice), spread);
        });
  }

  // Light along the ray, of which `left` reaches `from`; `passes`: the ray continues. What an event at the pixel's own
  // vertex meets is direct light, which other reservoirs have, except after deltas.
  struct MetPoint {
    const LightPoint<F>& point;
    const LightHit<F>& hit;
    const Spectrum<F>& left;
    M passes;
  };
  void meet(const MetPoint& met, F u, M on) {
    const PathWalk<F>& w = walk_;
    const M is_delta = w.by_delta != U(0u);
    const M counts = on & (is_delta | (w.events > U(1u)));
    const F share = weight_of_light_hit(settings_.light_weights(), w.density, is_delta, met.hit.density,
                                        M(met.point.place == in_lanes<F>(LightPlace::infinite)));
    const Spectrum<F> contribution = w.weight * met.left * met.hit.radiance * share;

    const M joined = counts & (w.joined != U(0u)), straight = w.joined + U(1u) == w.events;
    const M replays = counts & !joined & is_delta, point_of_light = counts & !joined & !is_delta;
    PathSample<F> sample = sample_so_far(w.events);
    sample.arriving = w.tail * met.left * met.hit.radiance * select(straight, F(1.0f), share);
    sample.contribution = w.until * sample.arriving;
    sample.end = select(replays, U(path_end::met), select(point_of_light, U(path_end::light), sample.end));
    sample.replayed = select(joined, sample.replayed, select(replays, w.events, w.events - U(1u)));
    sample.point = met.point;
    sample.contribution = select(replays, contribution, sample.contribution);
    if (any(point_of_light)) {
      const LightConnection<F> to = connect(shared_.scene.media, shared_.lights, w.from, met.point, point_of_light);
      sample.contribution = select(point_of_light, w.before * to.value, sample.contribution);
    }
    // Scattered again, a delta would meet with all emitters on its way at once.
    offer(sample, contribution, counts & !(replays & met.passes), u);
    if (const M alone = replays & met.passes; any(alone)) add_plain(contribution, alone);
  }

  void sample_light(const ReuseVertex<F>& vertex, const Leg<F>& leg, M on) {
    const PathWalk<F>& w = walk_;
    const EventNumbers<F> numbers(w.numbers, w.events);
    const RandomStream<F> own = numbers.light();
    const LightChoice<F> choice = shared_.lights.template choose<F>(vertex.p, vertex.light_normal, own.at(U(0u)), on);
    const LightPointDraw<F> draw = shared_.lights.template draw_light_point<F>(
        choice.light, vertex.p, vertex.light_normal, {own.at(U(1u)), own.at(U(2u))}, on & choice.valid);
    M lit = on & choice.valid & draw.valid;
    const LightConnection<F> to = connect(shared_.scene.media, shared_.lights, vertex, draw.point, lit);
    lit = is_open<F>(shared_.rays, vertex, to, lit & (to.target > F(0.0f)), counts_.shadow);
    if (!any(lit)) return;
    const Density<SolidAngle, F> density = choice.mass * draw.density;
    const F share = select(draw.point.place == in_lanes<F>(LightPlace::delta), F(1.0f),
                           weight_of_light_sample<F>(settings_.light_weights(), density, to.by_bsdf,
                                                     draw.point.place == in_lanes<F>(LightPlace::infinite)));
    // The density of the light point, in its own measure, is that of the direction times the geometry.
    const Spectrum<F> estimate = to.value * (share / select(lit, density.value * to.geometry, F(1.0f)));

    const M joined = lit & (w.joined != U(0u));
    const M joins = lit & !joined & may_join(leg, to.scattered.density);
    PathSample<F> sample = sample_so_far(w.events + U(1u));
    sample.arriving = w.tail * estimate, sample.contribution = w.until * sample.arriving;
    if (any(joins)) {
      sample.at = select_words(joins, surface_of(vertex), sample.at);
      sample.wi = select(joins, to.wi, sample.wi);
      sample.arriving = select(joins, to.arriving, sample.arriving);
      sample.contribution =
          select(joins, w.leaving * to.scattered.f_cos * to.arriving * geometry_of(leg, vertex), sample.contribution);
    }
    const M point_of_light = lit & !joined & !joins;
    sample.end = select(point_of_light, U(path_end::light), sample.end);
    sample.replayed = select(joined, sample.replayed, select(joins, w.events - U(1u), w.events));
    sample.point = draw.point;
    sample.contribution = select(point_of_light, w.weight * to.value, sample.contribution);
    offer(sample, w.weight * estimate, lit, numbers.choice(0));
  }

  PathSample<F> sample_so_far(U events) const {
    const PathWalk<F>& w = walk_;
    PathSample<F> sample{};
    sample.numbers = w.numbers, sample.events = events, sample.end = U(path_end::surface);
    sample.replayed = w.joined - U(1u), sample.at = w.at, sample.wi = w.wi, sample.time = w.from.time;
    return sample;
  }

  // Where no other pixel could scatter so often again, the light is this pixel's alone.
  void offer(const PathSample<F>& sample, const Spectrum<F>& contribution, M on, F u) {
    const M shared = on & (sample.replayed <= U(std::uint32_t(shared_.reuse.max_replayed)));
    const M known = is_finite(average(contribution));
    if (const M alone = on & !(shared & known); any(alone)) add_plain(contribution, alone);
    const M counts = shared & known & (usable_weight(average(sample.contribution)) > F(0.0f));
    chosen_.add(sample, select(counts, usable_weight(average(contribution)), F(0.0f)), u);
  }
  void add_plain(const Spectrum<F>& radiance, M on) { walk_.plain += select(on, radiance, gray(F(0.0f))); }

  // ---- the next event

  M may_join(const Leg<F>& leg, const Density<SolidAngle, F>& density) const {
    return shared_.reuse.joins ? (density.value > F(0.0f)) & leg.is_wide(density) : M(false);
  }
  static StoredSurface<F> surface_of(const ReuseVertex<F>& v) { return v; }
  F geometry_of(const Leg<F>& leg, const ReuseVertex<F>& vertex) const {
    return abs(dot(vertex.ng, walk_.d)) / leg.squared_length;
  }

  M scatter(const ReuseVertex<F>& vertex, const Leg<F>& leg, M on) {
    PathWalk<F>& w = walk_;
    const EventNumbers<F> numbers(w.numbers, w.events);
    const PathEvent<F> event = event_at(vertex, vertex.sampled(numbers.direction(), numbers.model(), on), on);
    const M broken = event.valid & !is_finite(average(event.weight));
    if (any(broken)) add_plain(event.weight, broken);
    const M continues = event.valid & !broken;

    const M behind = continues & (w.joined != U(0u));
    const M joins = continues & !event.delta & (w.joined == U(0u)) & may_join(leg, event.density) &
                    (w.events <= U(std::uint32_t(shared_.reuse.max_replayed) + 1));
    if (any(joins)) {
      w.at = select_words(joins, surface_of(vertex), w.at);
      w.wi = select(joins, event.wi, w.wi);
      w.until = select(joins, w.leaving * event.f_cos * geometry_of(leg, vertex), w.until);
      w.tail = select(joins, gray(F(1.0f)), w.tail);
      w.joined = select(joins, w.events, w.joined);
    }
    w.tail = select(behind, w.tail * event.weight, w.tail);
    w.before = select(continues, w.weight, w.before);
    w.leaving = select(continues, w.weight * event.f_cos, w.leaving);
    w.weight = select(continues, w.weight * event.weight, w.weight);
    w.eta_scale = select(continues, w.eta_scale * event.eta_scale, w.eta_scale);
    w.density = select(continues, event.density, w.density);
    w.by_delta = select(continues, select(event.delta, U(1u), U(0u)), w.by_delta);
    w.events = w.events + select(continues, U(1u), U(0u));
    w.from = select_words(continues, vertex, w.from);
    w.d = select(continues, event.wi, w.d);
    return lives_on(numbers, continues);
  }

  // No roulette on replayed events: throughputs differ between pixels.
  M lives_on(const EventNumbers<F>& numbers, M on) {
    PathWalk<F>& w = walk_;
    const M kept = (w.joined != U(0u)) | (w.events > U(std::uint32_t(shared_.reuse.max_replayed) + 1));
    const M plays = on & kept & (w.from.events + w.events > U(std::uint32_t(settings_.roulette_depth)));
    if (!any(plays)) return on;
    PathState<F> path{};
    path.throughput = w.weight, path.eta_scale = w.eta_scale;
    const Roulette<F> survival =
        roulette(select(plays, survival_probability(settings_, path), F(1.0f)), numbers.roulette());
    const M lives = on & survival.survives;
    w.weight = select(lives, w.weight * survival.weight, w.weight);
    w.tail = select(lives, w.tail * survival.weight, w.tail);
    return lives;
  }

  const PathScene<Rays>& shared_;
  const PathSettings& settings_;
  RayCounts& counts_;
  LaneQueue<PathWalk, F> walks_;
  PathWalk<F> walk_{};
  WeightedReservoir<PathSample<F>, F> chosen_;
};

}  // namespace montelux
