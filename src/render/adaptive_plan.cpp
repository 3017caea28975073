#include "render/adaptive_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace montelux {

namespace {

// Fewer passes of a tile have no usable error.
constexpr int min_passes = 4;
// Of the mean error, added to that of each tile.
constexpr double shrinkage = 0.3;
constexpr double max_share = 16;

// Errors of one pixel, weighted over 3 x 3 tiles by (1 2 1) in both directions.
std::vector<double> smoothed_errors(const std::vector<PilotTile>& tiles, int columns) {
  const int rows = int(tiles.size()) / columns;
  std::vector<double> smoothed(tiles.size());
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      double error = 0, pixels = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          if (x + dx < 0 || x + dx >= columns || y + dy < 0 || y + dy >= rows) continue;
          const PilotTile& tile = tiles[std::size_t((y + dy) * columns + x + dx)];
          const double weight = (2 - std::abs(dx)) * (2 - std::abs(dy));
          error += weight * tile.error, pixels += weight * tile.pixels;
        }
      smoothed[std::size_t(y * columns + x)] = error / pixels;
    }
  return smoothed;
}

// So that the mean weighted by cost is 1.
void normalise(const std::vector<PilotTile>& tiles, std::vector<double>& shares) {
  double cost = 0, of_shares = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) cost += tiles[t].cost, of_shares += tiles[t].cost * shares[t];
  for (double& share : shares) share *= cost / of_shares;
}

}  // namespace

std::vector<double> pass_shares(const std::vector<PilotTile>& tiles, int columns) {
  std::vector<double> shares(tiles.size(), 1.0);
  double error = 0, cost = 0, pixels = 0;
  for (const PilotTile& tile : tiles) error += tile.error, cost += tile.cost, pixels += tile.pixels;
  if (!(error > 0) || !std::isfinite(error) || !(cost > 0)) return shares;
  const std::vector<double> errors = smoothed_errors(tiles, columns);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    // Of a pixel, relative to the mean of all; half of the cost of a pass is taken as the same for all.
    const double own_cost = 0.5 + 0.5 * tiles[t].cost / tiles[t].pixels * pixels / cost;
    shares[t] = std::sqrt((errors[t] * pixels / error + shrinkage) / own_cost);
  }
  normalise(tiles, shares);
  for (double& share : shares) share = std::min(share, max_share);
  normalise(tiles, shares);
  return shares;
}

double expected_gain(const std::vector<PilotTile>& tiles, const std::vector<double>& shares) {
  double uniform = 0, adaptive = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) uniform += tiles[t].error, adaptive += tiles[t].error / shares[t];
  return adaptive > 0 ? uniform / adaptive : 1;
}

PilotTiles tiles_of_pilot(const Pilot& pilot, TargetMeasure measure, int tile_side) {
  const PixelBounds& bounds = pilot.film.bounds();
  FilmPlanes planes(bounds);
  planes.copy(pilot.film, bounds);
  Plane errors(std::size_t(bounds.area()));
  if (measure == TargetMeasure::mean) {
    for (const Plane& variance : planes.variance)
      for (std::size_t i = 0; i < errors.size(); ++i) errors[i] += variance[i];
  } else {
    errors = relative_errors(planes);
  }
  // The costs of the pilot's own tiles, by pixel.
  Plane costs(errors.size());
  std::size_t number = 0;
  for (const auto& [index, tile] : pilot.film.tiles()) {
    const double cost = double(pilot.rays.at(number++)) / tile.cells.area();
    for (int y = tile.cells.y0; y < tile.cells.y1; ++y)
      for (int x = tile.cells.x0; x < tile.cells.x1; ++x) costs[planes.index(x, y)] = float(cost);
  }
  PilotTiles result;
  result.columns = (bounds.width() + tile_side - 1) / tile_side;
  for (const PixelBounds& tile : tiles_of(bounds, tile_side)) {
    PilotTile& sums = result.tiles.emplace_back(PilotTile{0, 0, double(tile.area())});
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x)
        sums.error += double(errors[planes.index(x, y)]), sums.cost += double(costs[planes.index(x, y)]);
  }
  return result;
}

AdaptivePlan::AdaptivePlan(std::vector<double> shares, const std::optional<ErrorTarget>& target)
    : shares_(std::move(shares)), target_(target), looks_(target.value_or(ErrorTarget{})) {}

int AdaptivePlan::passes_at(int level, std::size_t tile) const {
  return std::max(std::min(level, min_passes), int(std::lround(level * shares_[tile])));
}

int AdaptivePlan::level_of(const Film& film, const PassPlan& passes) const {
  int low = 0, high = passes.passes;
  while (low < high) {
    const int middle = low + (high - low + 1) / 2;
    std::size_t number = 0;
    bool has_all = true;
    for (const auto& [index, tile] : film.tiles()) has_all &= int(tile.passes.size()) >= passes_at(middle, number++);
    has_all ? low = middle : high = middle - 1;
  }
  return low;
}

WorkRound AdaptivePlan::next_round(const Film& film, const PassPlan& passes) const {
  const int level = level_of(film, passes);
  if (level >= passes.passes) return {};
  bool is_whole = true;
  std::size_t number = 0;
  for (const auto& [index, tile] : film.tiles()) is_whole &= int(tile.passes.size()) == passes_at(level, number++);
  if (target_ && is_whole && looks_.is_look(level) && judge(*target_, film, false).reaches(*target_)) return {};
  const int end = std::min(looks_.after(level), passes.passes);
  // Level by level, so that a render that is stopped has about the same shares.
  std::vector<WorkUnit> units;
  for (int of_level = level + 1; of_level <= end; ++of_level)
    for (std::size_t tile = 0; tile < shares_.size(); ++tile)
      for (int pass = passes_at(of_level - 1, tile); pass < passes_at(of_level, tile); ++pass)
        units.push_back({tile, passes.first_pass + pass});
  const std::size_t count = units.size();
  return {count, [all = std::move(units)](std::size_t i) { return all[i]; }};
}

std::uint64_t AdaptivePlan::expected_units(const Film&, const PassPlan& passes) const {
  std::uint64_t units = 0;
  for (std::size_t tile = 0; tile < shares_.size(); ++tile) units += std::uint64_t(passes_at(passes.passes, tile));
  return units;
}

int adaptive_tile_side(int samples_per_pass) {
  constexpr int samples = 512;
  int side = 8;
  while (side < 32 && side * side * samples_per_pass < samples) side *= 2;
  return side;
}

std::optional<Pilot> run_pilot(const AnyIntegrator& integrator, RenderSettings settings, int samples,
                               RenderObserver& observer) {
  constexpr int part = 40, passes = 2;
  const int k = std::min((samples + part / 2) / (part * passes), 1024);
  if (k < 1) return std::nullopt;
  return pilot_of(integrator, std::move(settings), k, passes, observer);
}

}  // namespace montelux
