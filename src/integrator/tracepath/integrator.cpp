#include "integrator/tracepath/integrator.h"

#include <algorithm>

#include "integrator/first_vertex.h"
#include "integrator/path/first_hits.h"
#include "integrator/path/settings.h"
#include "integrator/tracepath/horizon.h"
#include "mc/hemisphere.h"
#include "mc/roulette.h"
#include "transport/connection.h"

namespace montelux {

namespace {

// The recursion of one camera ray.
struct Recursion {
  const Scene& scene;
  const Accel& accel;
  const TracePathSettings& settings;
  const std::vector<LightId>& polygons;
  RayCounts& counts;

  // TracePath(p', d): the radiance that leaves the surface at `at` toward where the ray came from.
  // `throughput` is that of the way from the camera, for roulette alone.
  Spectrum<float> radiance(const NextVertex<float>& at, RandomStream<float> random, int depth,
                           const Spectrum<float>& throughput) const {
    const bool emits = max_component(at.emitted) > 0;
    const float p_emit = !at.found ? 1.0f : emits ? settings.p_emit : 0.0f;
    if (random.next() < p_emit) return at.emitted * (1.0f / p_emit);
    const Spectrum<float> arrives = at.left * (1.0f / (1.0f - p_emit));
    return arrives * reflected(at, random, depth, throughput * arrives);
  }

 private:
  Spectrum<float> reflected(const NextVertex<float>& at, RandomStream<float>& random, int depth,
                            const Spectrum<float>& throughput) const {
    if (settings.max_depth && depth >= *settings.max_depth) return gray(0.0f);
    if (at.bsdf.is_delta) return along_bsdf(at, random, depth, throughput, {});
    Spectrum<float> sum = delta_lights(at, random);
    if (polygons.empty()) return sum + along_bsdf(at, random, depth, throughput, {});

    // Pick a light: whichever it is, the two directions together cover the hemisphere.
    const auto number = std::min(std::size_t(random.next() * float(polygons.size())), polygons.size() - 1);
    const LightId light = polygons[number];
    const LightSample<float> to =
        scene.lights.sample_light<float>(std::uint32_t(light), at.x.point.p, Vec3f{}, random.next2(), true);
    // From behind the light there is nothing to aim at, and the other direction has the whole hemisphere.
    if (to.valid) sum += continued(at, to.wi, to.density, random, depth, throughput);
    const SeenPolygon seen = to.valid ? seen_from(at, light) : SeenPolygon{};
    const bool one_side = length_squared(at.bsdf.light_normal) > 0.5f;
    return sum + (one_side ? elsewhere(at, seen, random, depth, throughput)
                           : along_bsdf(at, random, depth, throughput, seen));
  }

  // A direction uniform over the rest of the hemisphere: by rejection.
  Spectrum<float> elsewhere(const NextVertex<float>& at, const SeenPolygon& seen, RandomStream<float>& random,
                            int depth, const Spectrum<float>& throughput) const {
    const float rest = 2 * pi - solid_angle(above_horizon(seen, at.bsdf.light_normal));
    if (rest < 1e-4f) return gray(0.0f);
    const LocalFrame<float> frame = LocalFrame<float>::from_normal(at.bsdf.light_normal);
    for (int tries = 0; tries < 10000; ++tries) {
      const Vec3f wi = frame.to_world(sample_hemisphere(random.next2()));
      if (seen.count == 0 || !covers(seen, wi)) return continued(at, wi, {1 / rest}, random, depth, throughput);
    }
    return gray(0.0f);
  }

  // An independent stream, chosen by the next number of another.
  static RandomStream<float> own_stream(RandomStream<float>& random) {
    return random.fork(std::uint32_t(random.next() * 0x1p24f));
  }

  // f cos / density x TracePath in the direction wi.
  Spectrum<float> continued(const NextVertex<float>& at, const Vec3f& wi, Density<SolidAngle> density,
                            RandomStream<float>& random, int depth, const Spectrum<float>& throughput) const {
    BsdfContext<float> context = at.context;
    context.random = own_stream(random);
    const BsdfValue<float> value = evaluate<float>(at.bsdf.lanes(true), at.wo, at.bsdf.frame.to_local(wi), context);
    return next_call(at, wi, value.f_cos * (1.0f / density), random, depth, throughput);
  }

  // A direction by the BSDF; none where it is one of `taken`, which another term serves.
  Spectrum<float> along_bsdf(const NextVertex<float>& at, RandomStream<float>& random, int depth,
                             const Spectrum<float>& throughput, const SeenPolygon& taken) const {
    const float lobe = random.next();
    const Vec2f u = random.next2();
    const BsdfSample<float> next = sample<float>(at.bsdf.lanes(true), at.wo, Vec3f{lobe, u.x, u.y}, at.context);
    if (!next.valid) return gray(0.0f);
    const Vec3f wi = at.bsdf.frame.to_world(next.wi);
    if (taken.count > 0 && !next.delta && covers(taken, wi)) return gray(0.0f);
    return next_call(at, wi, next.weight, random, depth, throughput);
  }

  Spectrum<float> next_call(const NextVertex<float>& at, const Vec3f& wi, Spectrum<float> weight,
                            RandomStream<float>& random, int depth, const Spectrum<float>& throughput) const {
    const float u = random.next();
    if (!(max_component(weight) > 0)) return gray(0.0f);
    if (depth >= settings.roulette_depth) {
      const Roulette<float> survival = roulette(std::min(max_component(throughput * weight), max_survival), u);
      if (!survival.survives) return gray(0.0f);
      weight *= gray(survival.weight);
    }
    const RandomStream<float> branch = own_stream(random);
    const NextVertex<float> there = next_vertex<float>(scene, accel, at.reference_toward(wi), at.ray_toward(wi), true,
                                                       branch.fork(1u), counts.scattered, FullWeight{});
    return weight * radiance(there, branch.fork(2u), depth + 1, throughput * weight);
  }

  // Lights that no ray can meet are outside the recursion.
  Spectrum<float> delta_lights(const NextVertex<float>& at, RandomStream<float>& random) const {
    if (!scene.lights.has_delta()) return gray(0.0f);
    const ReferencePoint<float> from = at.reference();
    const float u = random.next();
    const LightSample<float> light = scene.lights.sample<float>(from.p, from.n, u, random.next2(), true);
    if (!light.valid || !light.delta) return gray(0.0f);
    const BsdfValue<float> value =
        evaluate<float>(at.bsdf.lanes(true), at.wo, at.bsdf.frame.to_local(light.wi), at.context);
    const Arriving<float> seen = arriving_from<float>(scene, accel, at, light.wi, light.distance, true,
                                                      at.context.random.fork(vertex_stream::shadow), counts.shadow);
    return seen.on ? value.f_cos * light.radiance * seen.left : gray(0.0f);
  }

  SeenPolygon seen_from(const NextVertex<float>& at, LightId light) const {
    const LightPolygon polygon = *scene.lights.polygon(light);
    SeenPolygon seen;
    seen.count = polygon.count;
    for (int i = 0; i < polygon.count; ++i)
      seen.corners[std::size_t(i)] = polygon.corners[std::size_t(i)] - at.x.point.p;
    return seen;
  }
};

}  // namespace

TracePathIntegrator::TracePathIntegrator(const Scene& scene, const Accel& accel, const TracePathSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings) {
  for (std::uint32_t i = 0; i < scene.lights.count(); ++i)
    if (scene.lights.polygon(LightId(i))) polygons_.push_back(LightId(i));
}

RayCounts TracePathIntegrator::trace(const TilePass& pass, std::span<PixelSample> out) const {
  std::fill(out.begin(), out.end(), PixelSample{});
  FirstHits<float> first_hits(scene_, accel_, pass, out);
  RayCounts counts;
  counts.camera = first_hits.rays();
  PathState<float> path{};
  const Recursion recursion{scene_, accel_, settings_, polygons_, counts};
  while (first_hits.refill(path, false)) {
    const auto sampler = numbers_of(pass.points, path);
    const RandomStream<float> random = sampler.stream(path_dimension::first_vertex + path_dimension::own);
    const NextVertex<float> at = first_vertex<float>(scene_, accel_, path, true, random.fork(1u), counts);
    out[path.output].radiance = to_rgb(recursion.radiance(at, random.fork(2u), 0, gray(1.0f)) * path.weight);
    if (at.found) {
      RandomStream<float> own = random.fork(3u);
      const float lobe = own.next();
      const Vec2f u = own.next2();
      write_features(at, sampled_albedo<float>(at, {lobe, u.x, u.y}, true), path, true, out);
    }
  }
  return counts;
}

static Fields<TracePathSettings> tracepath_fields() {
  Fields<TracePathSettings> fields;
  fields
      .number("p-emit", &TracePathSettings::p_emit, "probability of using emitted light where there is both", 0.001,
              0.999)
      .integer("roulette-depth", &TracePathSettings::roulette_depth, "scattering events before roulette", 0, 64)
      .other(max_depth_spec());
  return fields;
}

EntitySpec tracepath_spec() {
  return {"tracepath",
          "the recursive TracePath of COS 526, corrected: emitted light, or two rays: to a light, and elsewhere",
          tracepath_fields().specs({})};
}

TracePathSettings tracepath_settings(const ParameterList& list) {
  TracePathSettings s;
  // None of the rows can fail: their values have been checked.
  (void)tracepath_fields().read(list, s);
  return s;
}

}  // namespace montelux
