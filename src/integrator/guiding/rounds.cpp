#include "integrator/guiding/rounds.h"

#include <algorithm>
#include <cmath>

#include "integrator/guiding/training.h"

namespace montelux {

namespace {

constexpr double first_paths = 4096;

}  // namespace

PathSettings for_training(const PathSettings& settings) {
  PathSettings own = settings;
  own.guide = std::make_shared<GuideField>(PlaceTree{}, std::vector<GuideField::Table>(1));
  if (own.roulette == PathRoulette::efficiency) own.roulette = PathRoulette::throughput;
  return own;
}

void trace_round(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& settings,
                 const TrainingRound& round, const TakeRecord& take) {
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
      tally.finish(out, take);
    }
}

std::vector<Vec3f> places_of_paths(const Scene& scene, const LightSet& lights, const Accel& rays,
                                   const PathSettings& settings) {
  std::vector<Vec3f> places;
  trace_round(scene, lights, rays, settings, {0, first_paths}, [&](const GuideRecord& r) { places.push_back(r.p); });
  return places;
}

void for_each_round(std::span<const double> totals, const std::function<void(const TrainingRound&)>& learn) {
  double before = 0, usual = first_paths;
  for (std::uint32_t number = 1;; ++number, usual *= 2) {
    double paths = usual;
    bool is_over = true;
    for (double total : totals)
      if (total > before) paths = std::min(paths, total - before), is_over = false;
    if (is_over) return;
    learn({number, paths, before});
    before += paths;
  }
}

}  // namespace montelux
