// The first stage of a frame: every pixel's path to its first rough surface, what it finds there by itself, and the
// rest of the path, whose light is not reused.
#pragma once
#include "integrator/path/first_hits.h"
#include "integrator/path/loop.h"
#include "integrator/restir/continuations.h"
#include "integrator/restir/first_candidates.h"
#include "integrator/restir/history.h"
#include "integrator/restir/path_candidates.h"
#include "transport/dimensions.h"
#include "transport/next_vertex.h"

namespace montelux {

// All that the stages of a series share and never change.
template <class Rays>
struct RestirScene {
  const Scene& scene;
  const LightTechniques& lights;
  const Rays& rays;
  const RestirSettings& settings;

  std::uint32_t max_events() const {
    return settings.path.max_depth ? std::uint32_t(*settings.path.max_depth) : 0x7fffffffu;
  }
  PathScene<Rays> paths() const { return {scene, lights.bvh, rays, settings.indirect, max_events()}; }
};

// Results go to `keep`: keep.lights(vertex, origin, reservoir, output, mask) and, where paths are reused,
// keep.paths(reservoir, output, mask). Pixels that are not reported have no vertex, or no path.
template <class F, class Rays, class Keep>
class FirstStage {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  FirstStage(const RestirScene<Rays>& shared, const TilePass& pass, std::span<PixelSample> out, Keep& keep)
      : shared_(shared),
        pass_(pass),
        out_(out),
        keep_(keep),
        max_depth_(U(shared.max_events())),
        behind_(shared.paths()),
        paths_(behind_, shared.settings.path, counts_) {}

  // Fills `out` with all light but that of the vertices' reservoirs.
  RayCounts run() {
    FirstHits<F> first_hits(shared_.scene, shared_.rays, pass_, out_, no_tally, shared_.settings.path.lamps());
    counts_.camera = first_hits.rays();
    PathState<F> path{};
    for (M on(false);;) {
      on = first_hits.refill(path, on);
      if (!any(on)) break;
      on = step(path, on, first_hits);
    }
    if (reuses_paths()) {
      paths_.run([&](const U& output, const PathReservoir<F>& reservoir, const Spectrum<F>& plain, M done) {
        for_each_lane(done, [&](int k) { out_[lane(output, k)].radiance += to_rgb(lane(plain, k)); });
        keep_.paths(reservoir, output, done);
      });
      return counts_;
    }
    std::vector<PixelSample> results(continuations_.count());
    counts_ += run_paths<F>(shared_.scene, shared_.lights.bvh, shared_.rays, shared_.settings.path, pass_,
                            std::span(results), continuations_, no_tally);
    continuations_.add_results(results, out_);
    return counts_;
  }

 private:
  using Candidates = FirstCandidates<F, Rays>;

  // Light that a path sees, which no other technique finds.
  struct SeenLight {
    const LightSet& lights;
    PathState<F>& path;
    const FirstHits<F>& source;

    void emitter(const EmitterOnRay<F>& met, M on) {
      on = source.counts_emitter(path, on);
      const SurfaceHit<F>& x = met.v.x;
      const U number = select(on, x.light - U(1u), U(0u));
      add(met.left, lights.template hit_radiance<F>(number, x.point.ng, x.point.uv, path.d, on), on);
    }
    void sky(const SkyOnRay<F>& met, M on) { add(met.left, lights.template escaped_radiance<F>(path.d, on), on); }

   private:
    void add(const Spectrum<F>& left, const Spectrum<F>& radiance, M on) {
      path.radiance += select(on, left * radiance, gray(F(0.0f)));
    }
  };

  // One surface of every path; gives the lanes that continue to another.
  M step(PathState<F>& path, M on, const FirstHits<F>& source) {
    const M may_scatter = path.depth < max_depth_;
    const auto sampler = numbers_of(pass_.points, path);
    const U dimension = U(path_dimension::first_vertex) + path.depth * U(path_dimension::per_vertex);
    const U own = U(path_dimension::own) + path.crossings * U(path_dimension::per_crossing);
    const VertexOrigin<F> origin{{path.o, path.d, path.hit.t, path.time}, path.hit, path.depth == U(0u)};
    RayProgress<F> way{{ray_of(path), path.hit, path.media}, path.throughput, F(1.0f), path.crossings};
    SeenLight seen{shared_.scene.lights, path, source};
    SegmentEnd<F> end = end_segment<F>(shared_.scene, way, {on, may_scatter}, sampler.stream(dimension + own), seen);
    Vertex<F>& v = end.v;
    v.context.on = on, v.context.densities = Densities::exact;
    const M passes = end.passes, scatters = on & may_scatter & !v.bsdf.is_interface;
    const M rough = scatters & !v.bsdf.is_delta;
    path.throughput = way.left, path.media = way.segment.media;
    const RandomStream<F> numbers = sampler.stream(U(path_dimension::reuse));
    const RandomStream<F> path_numbers = numbers.fork(U(restir_stream::path));
    const BsdfSample<F> next = leave(v, sampler, dimension, path_numbers, scatters);
    if (const M shown = is_shown(path, M(on & !passes), scatters); any(shown)) {
      const Vec2<F> u = sampler.get2(dimension + U(path_dimension::direction));
      write_features(first_sight(path, v.x, albedo_of(v, next, u, scatters & shown)), path, shown, out_);
    }

    // The vertex whose light is reused.
    const ReuseVertex<F> vertex = reuse_vertex(path, v, numbers);
    Candidates candidates(shared_.lights, shared_.rays, shared_.settings, vertex, counts_);
    if (any(rough)) {
      RandomStream<F> stream = numbers.fork(U(restir_stream::lights));
      candidates.draw_lights(stream, rough);
    }

    // Scatter; no roulette where other pixels replay these numbers.
    const M continues = scatter_path(path, next, M(scatters & next.valid));
    const M plays = continues & (path.depth > U(std::uint32_t(shared_.settings.path.roulette_depth))) &
                    !(rough & M(reuses_paths()));
    const M lives = survive_roulette(path, select(plays, survival_probability(shared_.settings.path, path), F(1.0f)),
                                     sampler.get1(dimension + U(path_dimension::roulette)), continues);
    const M offers = rough & continues & !next.delta & M(shared_.settings.bsdf_candidate);
    leave_vertex(path, v, select(passes, path.d, v.bsdf.frame.to_world(next.wi)), next, continues, passes);
    const M moves = passes | lives | offers;
    const M found = trace_path(path, shared_.rays, moves, counts_.scattered);

    // Light that the direction of the BSDF meets joins the candidates; light scattered there belongs to the path.
    if (any(offers)) offer(candidates, path, offers & found, offers & !found, numbers.fork(U(restir_stream::met)));
    if (any(rough)) keep(path, {vertex, origin}, candidates, rough);
    const M counts_next = lives & next.delta;
    if (reuses_paths())
      if (const M walks = rough & lives & (counts_next | (path.depth < max_depth_)); any(walks))
        paths_.begin(vertex, event_at(vertex, next, walks), path_numbers, path, found, walks);
    const M left = (moves & !found) & (passes | (lives & !rough) | (counts_next & !M(reuses_paths())));
    if (any(left)) seen.sky({path.throughput * path.media.left(F(ray_infinity)), F(1.0f), path.crossings}, left);
    const M remains = rough & lives & found & (counts_next | (path.depth < max_depth_));
    if (any(remains) && !reuses_paths()) hand_over(path, remains, counts_next);

    const M ended = on & (rough | !found | !moves);
    const Spectrum<F> radiance = path.radiance * path.weight;
    for_each_lane(ended, [&](int k) { out_[lane(path.output, k)].radiance = to_rgb(lane(radiance, k)); });
    return on & !ended;
  }

  bool reuses_paths() const { return shared_.settings.indirect.on; }

  // The direction in which a path leaves its vertex. At a rough one, whose sample is handed to other pixels, its
  // numbers are none that decide where the vertices of other pixels or frames are, as those of a smooth one do: points
  // of one set are not independent. Where paths are reused, others will scatter with the same numbers.
  BsdfSample<F> leave(const Vertex<F>& v, const NumberSource<F> auto& sampler, U dimension,
                      const RandomStream<F>& path_numbers, M on) const {
    const M smooth = v.bsdf.is_delta;
    const U place = select(smooth, dimension, U(path_dimension::rough_direction));
    const Vec2<F> u = sampler.get2(place + U(path_dimension::direction));
    const Vec3<F> own{sampler.get1(place + U(path_dimension::lobe)), u.x, u.y};
    if (!reuses_paths()) return sample<F>(v.bsdf.lanes(on), v.wo, own, v.context);
    const EventNumbers<F> first(path_numbers, U(0u));
    const BsdfContext<F> chosen{TransportMode::radiance, select_words(smooth, v.context.random, first.model()), on,
                                Densities::exact};
    return sample<F>(v.bsdf.lanes(on), v.wo, select(smooth, own, first.direction()), chosen);
  }

  ReuseVertex<F> reuse_vertex(const PathState<F>& path, const Vertex<F>& v, const RandomStream<F>& numbers) const {
    StoredOrigin<F> kept = stored_origin(v);
    kept.random = numbers.fork(U(restir_stream::bsdf));
    return {kept, path.throughput * path.weight, length(v.x.point.p - path.p), v.x.object, path.depth, U(1u)};
  }

  // The rest of a path takes its light from the next vertex on, in a state of its own.
  void hand_over(const PathState<F>& path, M on, M counts) {
    PathState<F> rest = path;
    rest.radiance = gray(F(0.0f));
    continuations_.add(rest, on, counts);
  }

  // The emitters along the direction of the BSDF, through interfaces, as candidates: each with a stream of its own.
  struct OfferedLight {
    Candidates& candidates;
    const Vec3<F>& d;
    const RandomStream<F>& numbers;

    void emitter(const EmitterOnRay<F>& met, M on) {
      candidates.add_hit(met.v.x, d, numbers.fork(met.crossings * U(2u)), on);
    }
    void sky(const SkyOnRay<F>& met, M on) { candidates.add_sky(d, numbers.fork(met.crossings * U(2u) + U(1u)), on); }
  };
  void offer(Candidates& candidates, const PathState<F>& path, M found, M left, const RandomStream<F>& numbers) {
    OfferedLight offered{candidates, path.d, numbers};
    if (any(left)) offered.sky({gray(F(1.0f)), F(1.0f), U(0u)}, left);
    if (!any(found)) return;
    RayProgress<F> way{{ray_of(path), path.hit, path.media}, gray(F(1.0f))};
    follow_segment<F>(shared_.scene, shared_.rays, way, {found, M(false)}, numbers.fork(U(restir_stream::interfaces)),
                      counts_.scattered, offered);
  }

  struct FoundVertex {
    const ReuseVertex<F>& vertex;
    const VertexOrigin<F>& origin;
  };
  void keep(PathState<F>& path, const FoundVertex& found, const Candidates& candidates, M rough) {
    const M broken = rough & candidates.broken();
    if (any(broken)) path.radiance += select(broken, gray(F(std::numeric_limits<float>::quiet_NaN())), gray(F(0.0f)));
    keep_.lights(found.vertex, found.origin, candidates.result(), path.output, rough);
  }

  const RestirScene<Rays>& shared_;
  const TilePass& pass_;
  std::span<PixelSample> out_;
  Keep& keep_;
  U max_depth_;
  Continuations<F> continuations_;
  RayCounts counts_;
  const PathScene<Rays> behind_;
  PathCandidates<F, Rays> paths_;
};

}  // namespace montelux
