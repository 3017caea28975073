#include "image/region_grid.h"

#include <algorithm>
#include <cmath>

#include "image/welch.h"

namespace montelux {
namespace {

RegionGrid empty_grid(int width, int height, int side) {
  RegionGrid grid;
  grid.width = width, grid.height = height, grid.side = side;
  const std::size_t size = std::size_t(width) * std::size_t(height);
  for (std::vector<double>* values :
       {&grid.difference, &grid.variance[0], &grid.variance[1], &grid.spread[0], &grid.spread[1], &grid.count})
    values->assign(size, 0.0);
  return grid;
}

double finite_or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

double finite_sum(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += finite_or_zero(value);
  return sum;
}

// The sums of values within `radius` along one axis: `count` values with distance `step`, starting at `first`.
void sum_along(const std::vector<double>& in, std::vector<double>& out, std::array<std::size_t, 3> axis, int radius) {
  const auto [first, step, count] = axis;
  const auto reach = std::size_t(radius);
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (std::size_t j = i > reach ? i - reach : 0; j <= std::min(i + reach, count - 1); ++j)
      sum += in[first + j * step];
    out[first + i * step] = sum;
  }
}

// The mean over the square of regions within `radius`, restricted to the image.
std::vector<double> mean_around(const std::vector<double>& values, int width, int height, int radius) {
  const auto w = std::size_t(width), h = std::size_t(height);
  std::vector<double> finite(values.size()), rows(values.size()), sums(values.size());
  std::transform(values.begin(), values.end(), finite.begin(), finite_or_zero);
  for (std::size_t y = 0; y < h; ++y) sum_along(finite, rows, {y * w, 1, w}, radius);
  for (std::size_t x = 0; x < w; ++x) sum_along(rows, sums, {x, w, h}, radius);
  const auto within = [radius](int at, int size) {
    return std::min(at + radius, size - 1) - std::max(at - radius, 0) + 1;
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      sums[std::size_t(y) * w + std::size_t(x)] /= double(within(x, width)) * double(within(y, height));
  return sums;
}

}  // namespace

RegionGrid pixel_grid(const EstimatedImage& a, const EstimatedImage& b, std::array<int, 2> channels) {
  RegionGrid grid = empty_grid(a.mean.width, a.mean.height, 1);
  const std::array<const EstimatedImage*, 2> images = {&a, &b};
  for (std::size_t k = 0; k < 2; ++k) {
    const PixelBuffer &mean = images[k]->mean, &error = images[k]->standard_error;
    const auto stride = mean.channels.size();
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const std::size_t at = i * stride + std::size_t(channels[k]);
      const double variance = double(error.values[at]) * double(error.values[at]);
      grid.difference[i] += k == 0 ? double(mean.values[at]) : -double(mean.values[at]);
      grid.variance[k][i] = variance;
      grid.spread[k][i] = variance * variance / images[k]->degrees_of_freedom;
    }
  }
  std::fill(grid.count.begin(), grid.count.end(), 1.0);
  return grid;
}

RegionGrid coarser(const RegionGrid& grid, int factor) {
  RegionGrid sums =
      empty_grid((grid.width + factor - 1) / factor, (grid.height + factor - 1) / factor, grid.side * factor);
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const auto from = std::size_t(y) * std::size_t(grid.width) + std::size_t(x);
      const auto to = std::size_t(y / factor) * std::size_t(sums.width) + std::size_t(x / factor);
      sums.difference[to] += grid.difference[from];
      for (std::size_t k = 0; k < 2; ++k) {
        sums.variance[k][to] += grid.variance[k][from];
        sums.spread[k][to] += grid.spread[k][from];
      }
      sums.count[to] += grid.count[from];
    }
  return sums;
}

std::array<std::vector<double>, 2> raised_variance(const RegionGrid& grid, int radius) {
  std::array<std::vector<double>, 2> raised = grid.variance;
  const std::array<double, 2> total = {finite_sum(grid.variance[0]), finite_sum(grid.variance[1])};
  if (total[0] > 0 && total[1] > 0)
    for (std::size_t k = 0; k < 2; ++k) {
      const double ratio = total[k] / total[1 - k];
      for (std::size_t i = 0; i < grid.size(); ++i)
        raised[k][i] = std::max(raised[k][i], ratio * finite_or_zero(grid.variance[1 - k][i]));
    }
  if (radius > 0)
    for (std::vector<double>& variance : raised) {
      const std::vector<double> around = mean_around(variance, grid.width, grid.height, radius);
      for (std::size_t i = 0; i < grid.size(); ++i) variance[i] = std::max(variance[i], around[i]);
    }
  return raised;
}

}  // namespace montelux
