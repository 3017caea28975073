#include "integrator/guiding/training.h"

#include <algorithm>
#include <cmath>

#include "integrator/guiding/learner.h"
#include "integrator/path/loop.h"

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

}  // namespace

GuideField train_guide(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& settings) {
  constexpr double first_paths = 4096, records_of_leaf = 2000;
  PathSettings own = settings;
  own.guide = std::make_shared<GuideField>(GuideTree{}, std::vector<GuideField::Table>(1));
  if (own.roulette == PathRoulette::efficiency) own.roulette = PathRoulette::throughput;
  std::vector<Vec3f> places;
  trace_round(scene, lights, rays, own, {0, first_paths}, [&](const GuideRecord& r) { places.push_back(r.p); });
  GuideLearner learner(places);
  std::uint32_t number = 1;
  for (double paths = first_paths, left = double(settings.guiding_paths); left > 0; left -= paths, paths *= 2) {
    if (number > 1) learner.refine(records_of_leaf);
    trace_round(scene, lights, rays, own, {number++, std::min(paths, left)},
                [&](const GuideRecord& r) { learner.add(r); });
    own.guide = std::make_shared<GuideField>(learner.field());
  }
  return *own.guide;
}

}  // namespace montelux
