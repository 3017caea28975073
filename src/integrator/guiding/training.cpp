#include "integrator/guiding/training.h"

#include <algorithm>
#include <cmath>

#include "integrator/guiding/learner.h"
#include "integrator/path/loop.h"
#include "light/sky_field.h"
#include "transport/visibility.h"

namespace montelux {

template <class Tally>
RayCounts trace_guided_paths(const Scene& scene, const LightSet& lights, const Accel& rays,
                             const PathSettings& settings, const TilePass& pass, std::span<PixelSample> out,
                             Tally& tally) {
  const FieldGuide guide{*settings.guide};
  const bool one = settings.lanes == Lanes::one, media = !scene.media.empty();
  if (media && one) return trace_paths<float, true>(scene, lights, rays, settings, pass, out, tally, guide);
  if (media) return trace_paths<NativeFloats, true>(scene, lights, rays, settings, pass, out, tally, guide);
  if (one) return trace_paths<float>(scene, lights, rays, settings, pass, out, tally, guide);
  return trace_paths<NativeFloats>(scene, lights, rays, settings, pass, out, tally, guide);
}

template RayCounts trace_guided_paths(const Scene&, const LightSet&, const Accel&, const PathSettings&, const TilePass&,
                                      std::span<PixelSample>, const NoTally&);
template RayCounts trace_guided_paths(const Scene&, const LightSet&, const Accel&, const PathSettings&, const TilePass&,
                                      std::span<PixelSample>, LayerTally&);
template RayCounts trace_guided_paths(const Scene&, const LightSet&, const Accel&, const PathSettings&, const TilePass&,
                                      std::span<PixelSample>, PilotTally&);

namespace {

// The paths of one round, spread over the picture.
struct Round {
  std::uint32_t number;
  double paths;
};

// Calls learn(record) for every record of a round.
template <class Learn>
void trace_round(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& settings,
                 const Round& round, Learn learn) {
  constexpr int tile_side = 16;
  const int width = std::max(settings.width, 1), height = std::max(settings.height, 1);
  PixelGrid grid{{0, 0, width, height}};
  grid.stride = std::max(1, int(std::ceil(std::sqrt(double(width) * height / round.paths))));
  const PixelBounds cells = grid.cells();
  const auto samples = std::uint32_t(std::max(1.0, std::round(round.paths / cells.area())));
  std::vector<PixelSample> out;
  for (int y = 0; y < cells.y1; y += tile_side)
    for (int x = 0; x < cells.x1; x += tile_side) {
      const PixelBounds tile{x, y, std::min(x + tile_side, cells.x1), std::min(y + tile_side, cells.y1)};
      const TilePass pass{
          .tile = tile, .points = {PointSetKind::padded_sobol, 0x6a09e667u, round.number, samples}, .grid = grid};
      out.assign(std::size_t(tile.area()) * samples, {});
      GuideTally tally(out.size());
      trace_guided_paths(scene, lights, rays, settings, pass, out, tally);
      tally.finish(out, learn);
    }
}

// Of a round before the others, which only shows where the paths come.
constexpr double first_paths = 4096;

// Settings of paths that teach, with a guide that knows nothing.
PathSettings for_training(const PathSettings& settings) {
  PathSettings own = settings;
  own.guide = std::make_shared<GuideField>(PlaceTree{}, std::vector<GuideField::Table>(1));
  if (own.roulette == PathRoulette::efficiency) own.roulette = PathRoulette::throughput;
  return own;
}

std::vector<Vec3f> places_of_paths(const Scene& scene, const LightSet& lights, const Accel& rays,
                                   const PathSettings& own) {
  std::vector<Vec3f> places;
  trace_round(scene, lights, rays, own, {0, first_paths}, [&](const GuideRecord& r) { places.push_back(r.p); });
  return places;
}

// Calls learn(round, is_first) for rounds of so many paths in all, each of twice as many as the one before.
template <class Learn>
void for_each_round(double all, Learn learn) {
  std::uint32_t number = 1;
  for (double paths = first_paths, left = all; left > 0; left -= paths, paths *= 2) {
    learn(Round{number, std::min(paths, left)}, number == 1);
    ++number;
  }
}

}  // namespace

GuideField train_guide(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& settings) {
  constexpr double records_of_leaf = 2000;
  PathSettings own = for_training(settings);
  GuideLearner learner(places_of_paths(scene, lights, rays, own));
  for_each_round(double(settings.guiding_paths), [&](const Round& round, bool is_first) {
    if (!is_first) learner.refine(records_of_leaf);
    trace_round(scene, lights, rays, own, round, [&](const GuideRecord& r) { learner.add(r); });
    own.guide = std::make_shared<GuideField>(learner.field());
  });
  return *own.guide;
}

namespace {

// Shadow rays toward the sky from vertices of paths, many at a time. What they teach does not depend on how many.
class SkyRays {
 public:
  using F = NativeFloats;
  SkyRays(const Scene& scene, const LightSet& lights, const Accel& rays, const SkyField& sky, std::uint32_t round)
      : scene_(scene), lights_(lights), rays_(rays), sky_(sky), round_(round) {}

  void add(const GuideRecord& place, SkyLearner& learner) {
    set_lane(p_, waiting_, place.p), set_lane(n_, waiting_, place.n);
    if (++waiting_ == lanes_of<F>) trace(learner);
  }
  // The rays of the last places, which may not fill a pack.
  void finish(SkyLearner& learner) {
    if (waiting_ > 0) trace(learner);
  }

 private:
  static constexpr int rays_of_place = 4;

  void trace(SkyLearner& learner) {
    const Mask<F> on = lane_index<F>() < Uint<F>(std::uint32_t(waiting_));
    RandomStream<F> random(lane_index<F>() + Uint<F>(number_), Uint<F>(0x452821e6u + round_));
    std::array<GuideRecord, std::size_t(rays_of_place * lanes_of<F>)> records;
    for (int i = 0; i < rays_of_place; ++i) {
      const LightSample<F> light =
          lights_.sample_light<F>(Uint<F>(std::uint32_t(sky_.light())), p_, n_, random.next2(), on);
      // The places alone are known, not the error of their coordinates: the rays start a little off.
      const F off = 1e-5f * scene_.lights.scene_radius();
      const Mask<F> one_sided = length_squared(n_) > F(0.5f);
      const F cosine = select(one_sided, max(dot(n_, light.wi), F(0.0f)), F(1.0f));
      const Ray<F> ray{p_ + select(one_sided, n_, light.wi) * off, light.wi, light.distance,
                       scene_.shutter.time(random.next())};
      const Mask<F> arrives = unblocked<F>(rays_, ray, Mask<F>(on & light.valid & (cosine > F(0.0f))), traced_);
      const F found = select(arrives, cosine * average(light.radiance) / light.density.value, F(0.0f));
      for_each_lane(on, [&](int k) {
        const Vec3f p = lane(p_, k), n = lane(n_, k), wi = lane(light.wi, k);
        records[std::size_t(k * rays_of_place + i)] = {
            p, n, sky_.in_light(wi), sky_.cell_mass(p, n, wi), 0, 0, 1, lane(found, k), 0, 0};
      });
    }
    for (int r = 0; r < waiting_ * rays_of_place; ++r) learner.add(records[std::size_t(r)]);
    number_ += std::uint32_t(waiting_), waiting_ = 0;
  }

  const Scene& scene_;
  const LightSet& lights_;
  const Accel& rays_;
  const SkyField& sky_;
  std::uint32_t round_, number_ = 0;  // of the first place that waits, in its round
  int waiting_ = 0;
  Vec3<F> p_{}, n_{};
  std::uint64_t traced_ = 0;
};

}  // namespace

std::shared_ptr<const SkyField> learn_sky(const Scene& scene, const LightSet& lights, const Accel& rays,
                                          const PathSettings& settings) {
  constexpr double records_of_leaf = 1000;
  const std::optional<SkyLight> light = lights.sky_light();
  if (!light) return nullptr;
  auto sky = std::make_shared<SkyField>(*light, PlaceTree{}, std::vector<SkyDirections::Table>(1));
  const PathSettings own = for_training(settings);
  SkyLearner learner(places_of_paths(scene, lights, rays, own));
  for_each_round(double(settings.sky_paths), [&](const Round& round, bool is_first) {
    if (!is_first) learner.refine(records_of_leaf);
    const LightSet known = lights.with(sky);
    SkyRays from_places(scene, known, rays, *sky, round.number);
    trace_round(scene, lights, rays, own, round, [&](const GuideRecord& place) { from_places.add(place, learner); });
    from_places.finish(learner);
    sky = std::make_shared<SkyField>(*light, learner.tree(), learner.tables());
  });
  return sky;
}

}  // namespace montelux
