#include "render/pass_shares.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "film/film_planes.h"

namespace montelux {

namespace {

// The squared error of a channel of the pixels of one tile: its variance, relative if `is_relative`. The divisors
// shrink toward the mean of the tile as far as noise explains how they differ (James and Stein 1961).
double error_of(const FilmPlanes& p, const PixelBounds& tile, std::size_t channel, bool is_relative) {
  const Plane &means = p.mean[channel], &variances = p.variance[channel];
  double sum = 0, mean = 0;
  const auto for_each_pixel = [&](auto f) {
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) f(p.index(x, y));
  };
  if (is_relative) for_each_pixel([&](std::size_t i) { mean += double(means[i]) / tile.area(); });
  for_each_pixel([&](std::size_t i) {
    const double variance = variances[i];
    double divisor = 1;
    if (is_relative) {
      const double difference = double(means[i]) - mean, square = difference * difference;
      const double value = mean + (square > variance ? 1 - variance / square : 0) * difference;
      divisor = value * value + relative_epsilon;
    }
    sum += variance / divisor;
  });
  return sum;
}

// The mean weighted by cost becomes 1, as far as the bounds allow.
void normalise(const std::vector<TileFigures>& tiles, double min_share, std::vector<double>& shares) {
  constexpr int steps = 30;
  constexpr double max_share = 16;
  for (int step = 0; step < steps; ++step) {
    double cost = 0, of_shares = 0;
    for (std::size_t t = 0; t < tiles.size(); ++t) cost += tiles[t].cost, of_shares += tiles[t].cost * shares[t];
    for (double& share : shares) share = std::clamp(share * cost / of_shares, min_share, max_share);
  }
}

// The root of error over cost of a pixel of each tile.
std::vector<double> roots_of(const std::vector<TileFigures>& tiles) {
  // Of the mean cost of a pixel; no pixel costs nothing.
  constexpr double min_cost = 0.02;
  double cost = 0, pixels = 0;
  for (const TileFigures& tile : tiles) cost += tile.cost, pixels += tile.pixels;
  std::vector<double> roots;
  for (const TileFigures& tile : tiles) {
    const double own_cost = cost > 0 ? std::max(tile.cost / tile.pixels * pixels / cost, min_cost) : 1;
    roots.push_back(std::sqrt(tile.error / tile.pixels / own_cost));
  }
  return roots;
}

constexpr int reach = 2;  // tiles

// Calls f(tile, weight) for the tiles around one, without itself.
template <class Function>
void for_each_around(const ImageFigures& image, std::size_t tile, Function f) {
  const int columns = image.columns, rows = int(image.tiles.size()) / columns;
  const int x = int(tile) % columns, y = int(tile) / columns;
  for (int j = std::max(y - reach, 0); j <= std::min(y + reach, rows - 1); ++j)
    for (int i = std::max(x - reach, 0); i <= std::min(x + reach, columns - 1); ++i) {
      if (i == x && j == y) continue;
      const auto other = std::size_t(j * columns + i);
      f(other, image.tiles[other].pixels / (1 + 2.0 * ((i - x) * (i - x) + (j - y) * (j - y))));
    }
}

// Means over the tiles around each.
std::vector<double> means_around(const ImageFigures& image, const std::vector<double>& values) {
  std::vector<double> means;
  for (std::size_t t = 0; t < values.size(); ++t) {
    double sum = 0, weights = 0;
    for_each_around(image, t, [&](std::size_t other, double w) { sum += w * values[other], weights += w; });
    means.push_back(weights > 0 ? sum / weights : 0);
  }
  return means;
}

// A mean that a few tiles hardly change, however large their values are.
double robust_mean(const ImageFigures& image, const std::vector<double>& values) {
  double sum = 0, pixels = 0;
  for (std::size_t t = 0; t < values.size(); ++t)
    sum += image.tiles[t].pixels * std::sqrt(values[t]), pixels += image.tiles[t].pixels;
  return sum * sum / (pixels * pixels);
}

// A tile gets its share only if the shares are a gain for the tiles that are not around it: where most of the error is
// that of a few tiles among others without error, it is not foreseen by what is around them, and all shares are 1.
void keep_if_gain(const ImageFigures& image, std::vector<double>& shares) {
  double even = 0, divided = 0;
  const auto errors_of = [&](std::size_t t) {
    return std::pair(image.tiles[t].error, image.tiles[t].error / shares[t]);
  };
  for (std::size_t t = 0; t < shares.size(); ++t) even += errors_of(t).first, divided += errors_of(t).second;
  std::vector<double> kept;
  for (std::size_t t = 0; t < shares.size(); ++t) {
    double of_even = even - errors_of(t).first, of_divided = divided - errors_of(t).second;
    for_each_around(image, t, [&](std::size_t other, double) {
      of_even -= errors_of(other).first, of_divided -= errors_of(other).second;
    });
    // Rounding of the sums counts as no difference.
    kept.push_back(of_divided <= of_even + 1e-9 * even ? shares[t] : 1);
  }
  shares = std::move(kept);
}

}  // namespace

ImageFigures figures_of(const Film& film, std::span<const std::uint64_t> rays, TargetMeasure measure, int tile_side) {
  const PixelBounds& bounds = film.bounds();
  FilmPlanes planes(bounds);
  planes.copy(film, bounds);
  // The costs of the film's own tiles, by pixel. Camera rays are traced in packets, and many of them see only the sky:
  // with all else that a sample takes, such a ray costs half as much as another one.
  constexpr double of_camera_ray = 0.5;
  Plane costs(std::size_t(bounds.area()));
  std::size_t number = 0;
  for (const auto& [index, tile] : film.tiles()) {
    const double samples = film.samples(tile.cells.x0, tile.cells.y0);
    const double cost = double(rays[number++]) / tile.cells.area() - (1 - of_camera_ray) * samples;
    for (int y = tile.cells.y0; y < tile.cells.y1; ++y)
      for (int x = tile.cells.x0; x < tile.cells.x1; ++x) costs[planes.index(x, y)] = float(cost);
  }
  ImageFigures image;
  image.columns = (bounds.width() + tile_side - 1) / tile_side;
  for (const PixelBounds& tile : tiles_of(bounds, tile_side)) {
    TileFigures& figures = image.tiles.emplace_back(TileFigures{0, 0, double(tile.area())});
    for (std::size_t c = 0; c < rgb_size; ++c)
      figures.error += error_of(planes, tile, c, measure != TargetMeasure::mean) / rgb_size;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) figures.cost += double(costs[planes.index(x, y)]);
  }
  return image;
}

std::vector<double> pass_shares(const ImageFigures& image, double min_share) {
  // Of the mean of all, added to each.
  constexpr double of_mean = 0.2;
  std::vector<double> shares(image.tiles.size(), 1.0);
  const std::vector<double> roots = roots_of(image.tiles);
  const double mean = robust_mean(image, roots);
  if (!(mean > 0) || !std::isfinite(mean) || shares.size() == 1) return shares;
  const std::vector<double> around = means_around(image, roots);
  for (std::size_t t = 0; t < shares.size(); ++t) shares[t] = around[t] + of_mean * mean;
  normalise(image.tiles, min_share, shares);
  keep_if_gain(image, shares);
  normalise(image.tiles, min_share, shares);
  return shares;
}

double expected_gain(const ImageFigures& image, const std::vector<double>& shares) {
  double uniform = 0, adaptive = 0;
  for (std::size_t t = 0; t < shares.size(); ++t)
    uniform += image.tiles[t].error, adaptive += image.tiles[t].error / shares[t];
  return adaptive > 0 ? uniform / adaptive : 1;
}

}  // namespace montelux
