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

// The choice between more lights without a place is not learned: it would take too long.
constexpr std::size_t max_lights_beyond = 16;

// A shadow ray of a place, in every lane.
struct DrawnRay {
  LightSample<F> light;
  LightChoice<F> choice;  // of the light
};
// What one of them found. contribution: with nothing in the way.
struct RayFinding {
  Vec3f p, n, wi;
  LightId light;
  float mass;  // with which the light was chosen; 0: none was
  float contribution;
  bool arrives;
};

// Shadow rays from the vertices of so many paths, many rays at a time, teach a pupil. What they teach does not depend
// on how many. The pupil has `void begin_round(bool is_first)`, `DrawnRay draw(p, n, random, on)`, `void
// learn(const RayFinding&)` and `void end_round()`.
template <class Pupil>
class Lessons {
 public:
  Lessons(const Scene& scene, const Accel& rays, double paths, std::uint32_t stream, Pupil& pupil)
      : scene_(scene), rays_(rays), paths_(paths), stream_(stream), pupil_(pupil) {}

  double paths() const { return paths_; }
  void begin(const TrainingRound& round) {
    has_begun_ = round.before < paths_;
    if (has_begun_) pupil_.begin_round(round.before == 0);
  }
  void add(const GuideRecord& place) {
    if (!has_begun_) return;
    set_lane(p_, waiting_, place.p), set_lane(n_, waiting_, place.n);
    if (++waiting_ == lanes_of<F>) trace();
  }
  void end() {
    if (!has_begun_) return;
    // The last places may not fill a pack.
    if (waiting_ > 0) trace();
    pupil_.end_round();
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
        findings[std::size_t(k * rays_of_place + i)] = {lane(p_, k),
                                                        lane(n_, k),
                                                        lane(light.wi, k),
                                                        LightId(lane(drawn.choice.light, k)),
                                                        lane(drawn.choice.mass.value, k),
                                                        lane(expected, k),
                                                        lane(arrives, k)};
      });
    }
    for (int r = 0; r < waiting_ * rays_of_place; ++r) pupil_.learn(findings[std::size_t(r)]);
    number_ += std::uint32_t(waiting_), waiting_ = 0;
  }

  const Scene& scene_;
  const Accel& rays_;
  double paths_;
  std::uint32_t stream_, number_ = 0;  // of the first place that waits
  Pupil& pupil_;
  bool has_begun_ = false;
  int waiting_ = 0;
  Vec3<F> p_{}, n_{};
  std::uint64_t traced_ = 0;
};

// The vertices of the same paths teach all of them, in rounds.
template <class... Pupils>
void teach(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& own,
           Lessons<Pupils>&... lessons) {
  const std::array totals{lessons.paths()...};
  for_each_round(totals, [&](const TrainingRound& round) {
    (lessons.begin(round), ...);
    trace_round(scene, lights, rays, own, round, [&](const GuideRecord& place) { (lessons.add(place), ...); });
    (lessons.end(), ...);
  });
}

class SkyPupil {
 public:
  SkyPupil(const LightSet& lights, const SkyLight& light, std::span<const Vec3f> places)
      : lights_(lights), light_(light), learner_(places) {}

  void begin_round(bool is_first) {
    constexpr double records_of_leaf = 1000;
    if (is_first)
      sky_ = std::make_shared<SkyField>(light_, PlaceTree{}, std::vector<SkyDirections::Table>(1));
    else
      learner_.refine(records_of_leaf);
    known_ = lights_.with(sky_);
  }
  DrawnRay draw(const Vec3<F>& p, const Vec3<F>& n, RandomStream<F>& random, Mask<F> on) const {
    const Uint<F> number(std::uint32_t(light_.light));
    return {known_.sample_light<F>(number, p, n, random.next2(), on), {number, {F(1.0f)}, on}};
  }
  void learn(const RayFinding& r) {
    const Vec3f wi = sky_->in_light(r.wi);
    learner_.add({r.p, r.n, wi, sky_->cell_mass(r.p, r.n, wi), 0, 0, 1, r.arrives ? r.contribution : 0.0f, 0, 0});
  }
  void end_round() { sky_ = std::make_shared<SkyField>(light_, learner_.tree(), learner_.tables()); }
  std::shared_ptr<const SkyField> field() const { return sky_; }

 private:
  const LightSet& lights_;
  SkyLight light_;
  LightSet known_;
  std::shared_ptr<const SkyField> sky_;
  SkyLearner learner_;
};

class ClusterPupil {
 public:
  // `sky`: what the same lessons teach of the sky, if they do.
  ClusterPupil(const LightSet& lights, std::span<const Vec3f> places, const SkyPupil& sky)
      : lights_(lights), sky_(sky), learner_(places, lights) {}

  void begin_round(bool is_first) {
    constexpr double records_of_leaf = 300;
    if (!is_first) learner_.refine(records_of_leaf);
    known_ = lights_.with(sky_.field());
  }
  DrawnRay draw(const Vec3<F>& p, const Vec3<F>& n, RandomStream<F>& random, Mask<F> on) const {
    // Each light without a place has a third of the rays that the hierarchy has.
    const std::span<const std::uint32_t> beyond = lights_.beyond();
    const auto count = std::uint32_t(beyond.size());
    const LightBvh& bvh = lights_.hierarchy();
    const float share = bvh.empty() ? 1.0f : float(count) / float(count + 3);
    const F u = random.next();
    const Mask<F> to_beyond = on & (random.next() < F(share)), to_placed = on & !to_beyond;
    LightChoice<F> choice =
        field_ ? bvh.choose(p, n, u, to_placed, field_->at(p, n, to_placed)) : bvh.choose(p, n, u, to_placed);
    if (any(to_beyond)) {
      const Uint<F> place = min(to_uint(u * float(count)), Uint<F>(count - 1));
      choice.light = select(to_beyond, gather(beyond.data(), place), choice.light);
      choice.mass.value = select(to_beyond, F(1.0f), choice.mass.value);
      choice.valid = choice.valid | to_beyond;
    }
    LightSample<F> light = known_.sample_light<F>(choice.light, p, n, random.next2(), choice.valid);
    light.valid = light.valid & choice.valid;
    choice.mass.value = select(choice.valid, choice.mass.value, F(0.0f));
    return {light, choice};
  }
  void learn(const RayFinding& r) {
    if (r.mass > 0) learner_.add({r.p, r.n, r.light, r.mass, r.contribution, r.arrives});
  }
  void end_round() { field_ = std::make_shared<ClusterField>(learner_.field()); }
  std::shared_ptr<const ClusterField> field() const { return field_; }

 private:
  const LightSet& lights_;
  const SkyPupil& sky_;
  LightSet known_;
  std::shared_ptr<const ClusterField> field_;
  ClusterLearner learner_;
};

}  // namespace

LearnedLights learn_lights(const Scene& scene, const LightSet& lights, const Accel& rays,
                           const PathSettings& settings) {
  const std::optional<SkyLight> light = lights.sky_light();
  const bool has_choice = lights.settings().selection == LightSelection::bvh && lights.count() > 1 &&
                          lights.beyond().size() <= max_lights_beyond;
  const int sky_paths = settings.sky_learning && light ? settings.sky_paths : 0;
  const int light_paths = settings.learned_selection && has_choice ? settings.light_paths : 0;
  if (sky_paths == 0 && light_paths == 0) return {};
  PathSettings own = for_training(settings);
  own.nee = false;  // only the vertices matter
  const std::vector<Vec3f> places = places_of_paths(scene, lights, rays, own);
  SkyPupil sky(lights, light.value_or(SkyLight{}), places);
  ClusterPupil clusters(lights, places, sky);
  Lessons of_sky(scene, rays, sky_paths, 0x452821e6u, sky);
  Lessons of_clusters(scene, rays, light_paths, 0x13198a2eu, clusters);
  teach(scene, lights, rays, own, of_sky, of_clusters);
  return {clusters.field(), sky.field()};
}

}  // namespace montelux
