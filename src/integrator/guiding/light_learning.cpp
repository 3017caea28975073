// What shadow rays before a render teach next-event estimation.
#include "integrator/guiding/cluster_learner.h"
#include "integrator/guiding/learner.h"
#include "integrator/guiding/rounds.h"
#include "integrator/guiding/training.h"
#include "light/sky_field.h"
#include "scene/scene.h"
#include "transport/visibility.h"

namespace montelux {

namespace {

using F = NativeFloats;

// A shadow ray of a place, in every lane.
struct DrawnRay {
  LightSample<F> light;
  Uint<F> number;  // of the light
};
// What one of them found. contribution: with nothing in the way.
struct RayFinding {
  Vec3f p, n, wi;
  LightId light;
  float contribution;
  bool arrives;
};

// Shadow rays from vertices of paths, many at a time. What they teach does not depend on how many. A pupil has
// `DrawnRay draw(p, n, random, on)` and `void learn(const RayFinding&)`.
template <class Pupil>
class ShadowRays {
 public:
  ShadowRays(const Scene& scene, const Accel& rays, std::uint32_t stream, Pupil& pupil)
      : scene_(scene), rays_(rays), stream_(stream), pupil_(pupil) {}

  void add(const GuideRecord& place) {
    set_lane(p_, waiting_, place.p), set_lane(n_, waiting_, place.n);
    if (++waiting_ == lanes_of<F>) trace();
  }
  // The rays of the last places, which may not fill a pack.
  void finish() {
    if (waiting_ > 0) trace();
  }

 private:
  static constexpr int rays_of_place = 4;

  void trace() {
    const Mask<F> on = lane_index<F>() < Uint<F>(std::uint32_t(waiting_));
    RandomStream<F> random(lane_index<F>() + Uint<F>(number_), Uint<F>(stream_));
    std::array<RayFinding, std::size_t(rays_of_place * lanes_of<F>)> findings;
    for (int i = 0; i < rays_of_place; ++i) {
      const DrawnRay drawn = pupil_.draw(p_, n_, random, on);
      const LightSample<F>& light = drawn.light;
      // The places alone are known, not the error of their coordinates: the rays start a little off.
      const F off = 1e-5f * scene_.lights.scene_radius();
      const Mask<F> one_sided = length_squared(n_) > F(0.5f);
      const F cosine = select(one_sided, max(dot(n_, light.wi), F(0.0f)), F(1.0f));
      const Ray<F> ray{p_ + select(one_sided, n_, light.wi) * off, light.wi, light.distance,
                       scene_.shutter.time(random.next())};
      const Mask<F> reaches = on & light.valid & (cosine > F(0.0f));
      const Mask<F> arrives = unblocked<F>(rays_, ray, reaches, traced_);
      const F expected = select(reaches, cosine * average(light.radiance) / light.density.value, F(0.0f));
      for_each_lane(on, [&](int k) {
        findings[std::size_t(k * rays_of_place + i)] = {lane(p_, k),       lane(n_, k),
                                                        lane(light.wi, k), LightId(lane(drawn.number, k)),
                                                        lane(expected, k), lane(arrives, k)};
      });
    }
    for (int r = 0; r < waiting_ * rays_of_place; ++r) pupil_.learn(findings[std::size_t(r)]);
    number_ += std::uint32_t(waiting_), waiting_ = 0;
  }

  const Scene& scene_;
  const Accel& rays_;
  std::uint32_t stream_, number_ = 0;  // of the first place that waits
  Pupil& pupil_;
  int waiting_ = 0;
  Vec3<F> p_{}, n_{};
  std::uint64_t traced_ = 0;
};

// Lets the pupil learn in rounds. It has, beside what ShadowRays calls, `begin_round(is_first)` and `end_round()`.
template <class Pupil>
void teach(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& own, double paths,
           Pupil& pupil) {
  for_each_round(paths, [&](const TrainingRound& round, bool is_first) {
    pupil.begin_round(is_first);
    ShadowRays<Pupil> from_places(scene, rays, 0x452821e6u + round.number, pupil);
    trace_round(scene, lights, rays, own, round, [&](const GuideRecord& place) { from_places.add(place); });
    from_places.finish();
    pupil.end_round();
  });
}

class SkyPupil {
 public:
  SkyPupil(const LightSet& lights, const SkyLight& light, std::span<const Vec3f> places)
      : lights_(lights), light_(light), learner_(places) {
    sky_ = std::make_shared<SkyField>(light, PlaceTree{}, std::vector<SkyDirections::Table>(1));
  }

  void begin_round(bool is_first) {
    constexpr double records_of_leaf = 1000;
    if (!is_first) learner_.refine(records_of_leaf);
    known_ = lights_.with(sky_);
  }
  DrawnRay draw(const Vec3<F>& p, const Vec3<F>& n, RandomStream<F>& random, Mask<F> on) const {
    const Uint<F> number(std::uint32_t(light_.light));
    return {known_.sample_light<F>(number, p, n, random.next2(), on), number};
  }
  void learn(const RayFinding& r) {
    learner_.add({r.p, r.n, sky_->in_light(r.wi), sky_->cell_mass(r.p, r.n, r.wi), 0, 0, 1,
                  r.arrives ? r.contribution : 0.0f, 0, 0});
  }
  void end_round() { sky_ = std::make_shared<SkyField>(light_, learner_.tree(), learner_.tables()); }
  std::shared_ptr<const SkyField> sky() const { return sky_; }

 private:
  const LightSet& lights_;
  SkyLight light_;
  LightSet known_;
  std::shared_ptr<const SkyField> sky_;
  SkyLearner learner_;
};

class ClusterPupil {
 public:
  ClusterPupil(const LightSet& lights, std::span<const Vec3f> places)
      : lights_(lights), learner_(places, lights.hierarchy()) {}

  void begin_round(bool is_first) {
    constexpr double records_of_leaf = 300;
    if (!is_first) learner_.refine(records_of_leaf);
  }
  DrawnRay draw(const Vec3<F>& p, const Vec3<F>& n, RandomStream<F>& random, Mask<F> on) const {
    const LightBvh& bvh = lights_.hierarchy();
    const F u = random.next();
    const LightChoice<F> choice = field_ ? bvh.choose(p, n, u, on, field_->at(p, n, on)) : bvh.choose(p, n, u, on);
    LightSample<F> light = lights_.sample_light<F>(choice.light, p, n, random.next2(), choice.valid);
    light.valid = light.valid & choice.valid;
    return {light, select(choice.valid, choice.light, Uint<F>(none))};
  }
  void learn(const RayFinding& r) {
    if (r.light != LightId(none)) learner_.add({r.p, r.n, r.light, r.contribution, r.arrives});
  }
  void end_round() { field_ = std::make_shared<ClusterField>(learner_.field()); }
  std::shared_ptr<const ClusterField> field() const { return field_; }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;

  const LightSet& lights_;
  std::shared_ptr<const ClusterField> field_;
  ClusterLearner learner_;
};

}  // namespace

std::shared_ptr<const SkyField> learn_sky(const Scene& scene, const LightSet& lights, const Accel& rays,
                                          const PathSettings& settings) {
  const std::optional<SkyLight> light = lights.sky_light();
  if (!light) return nullptr;
  const PathSettings own = for_training(settings);
  SkyPupil pupil(lights, *light, places_of_paths(scene, lights, rays, own));
  teach(scene, lights, rays, own, settings.sky_paths, pupil);
  return pupil.sky();
}

std::shared_ptr<const ClusterField> learn_clusters(const Scene& scene, const LightSet& lights, const Accel& rays,
                                                   const PathSettings& settings) {
  if (lights.hierarchy().cluster_links().size() < 2) return nullptr;
  const PathSettings own = for_training(settings);
  ClusterPupil pupil(lights, places_of_paths(scene, lights, rays, own));
  teach(scene, lights, rays, own, settings.light_paths, pupil);
  return pupil.field();
}

}  // namespace montelux
