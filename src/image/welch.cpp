#include "image/welch.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "image/region_grid.h"
#include "math/special.h"

namespace montelux {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int block_size = 8;
// The radius around a region within which variances are compared, in regions.
constexpr int pixel_radius = 3, block_radius = 0;

using Images = std::array<const EstimatedImage*, 2>;

// One region: sums over its pixels.
struct Test {
  double difference, variance, grain, degrees_of_freedom, count;

  double t() const {
    if (difference == 0) return 0;
    const double all = variance + grain * std::fabs(difference);
    return all > 0 ? difference / std::sqrt(all) : std::copysign(infinity, difference);
  }
  // The smallest difference of means whose |t| is at least q.
  double detectable(double q) const {
    const double g = q * q * grain;
    return 0.5 * (g + std::sqrt(g * g + 4 * q * q * variance)) / count;
  }
};

double p_value(double t, double degrees_of_freedom) {
  if (std::isnan(t) || std::isinf(t)) return 0;
  return 2 * special::student_t_tail(std::fabs(t), degrees_of_freedom);
}

// The tests of one channel for one size of region.
class GridTests {
 public:
  // `grain` of each image; 0 where errors are known.
  GridTests(const RegionGrid& grid, const Images& images, const std::array<double, 2>& grain, int radius)
      : grid_(grid), images_(images), grain_(grain), variance_(raised_variance(grid, radius)) {
    for (std::size_t k = 0; k < 2; ++k)
      if (std::isinf(images[k]->degrees_of_freedom)) variance_[k] = grid.variance[k];
  }

  std::size_t size() const { return grid_.size(); }
  const RegionGrid& grid() const { return grid_; }

  Test operator[](std::size_t i) const {
    double variance = 0, spread = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const double own = grid_.variance[k][i], raised = variance_[k][i];
      const double freedom = grid_.spread[k][i] > 0 ? own * own / grid_.spread[k][i] : images_[k]->degrees_of_freedom;
      variance += raised;
      spread += raised * raised / freedom;
    }
    const double difference = grid_.difference[i];
    return {difference, variance, grain_[difference < 0 ? 0 : 1], spread > 0 ? variance * variance / spread : infinity,
            grid_.count[i]};
  }

 private:
  const RegionGrid& grid_;
  Images images_;
  std::array<double, 2> grain_;
  std::array<std::vector<double>, 2> variance_;
};

// Collects the tests of a scale. `factor`: the factor by which standard errors are too small.
class Judge {
 public:
  explicit Judge(WelchScale& scale) : scale_(scale) {}

  void consider(const Test& test, double factor, std::array<int, 2> corner, int channel) {
    ++scale_.tests;
    if (std::isfinite(test.variance)) errors_.push_back(float(factor * std::sqrt(test.variance) / test.count));
    const double t = test.t() / factor;
    // No t-distribution has shorter tails than the normal one, so that most tests are decided without a p-value.
    if (scale_.tests > 1 && std::fabs(t) <= beyond_) return;
    const double p = p_value(t, test.degrees_of_freedom);
    if (scale_.tests > 1 && !(p < scale_.smallest_p || (p == scale_.smallest_p && std::fabs(t) > std::fabs(scale_.t))))
      return;
    best_ = test, best_factor_ = factor;
    beyond_ = p > 0 ? -special::normal_quantile(0.5 * p) : std::fabs(t);
    scale_.smallest_p = p, scale_.t = t, scale_.difference = test.difference / test.count;
    scale_.x = corner[0], scale_.y = corner[1], scale_.channel = channel;
  }

  void consider(const GridTests& tests, double factor, int channel) {
    const RegionGrid& grid = tests.grid();
    for (std::size_t i = 0; i < tests.size(); ++i) {
      const std::size_t before = scale_.tests;
      const double p = scale_.smallest_p, t = scale_.t;
      const int x = int(i % std::size_t(grid.width)) * grid.side, y = int(i / std::size_t(grid.width)) * grid.side;
      consider(tests[i], factor, {x, y}, channel);
      if (before == 0 || p != scale_.smallest_p || t != scale_.t) scale_.side = grid.side;
    }
  }

  void finish(double level) {
    const double share = level / double(scale_.tests);
    scale_.differs = scale_.smallest_p < share;
    const double q = -special::student_t_quantile(0.5 * share, best_.degrees_of_freedom) * best_factor_;
    scale_.detectable = best_.detectable(q);
    if (errors_.empty()) return;
    const auto middle = errors_.begin() + std::ptrdiff_t(errors_.size() / 2);
    std::nth_element(errors_.begin(), middle, errors_.end());
    const double best_error = best_factor_ * std::sqrt(best_.variance) / best_.count;
    scale_.detectable_median = best_error > 0 ? scale_.detectable * double(*middle) / best_error : 0;
  }

 private:
  WelchScale& scale_;
  Test best_{};
  double best_factor_ = 1, beyond_ = 0;
  std::vector<float> errors_;
};

std::array<std::array<int, 3>, 2> channels_of(const Images& images) {
  return {rgb_channels(images[0]->mean), rgb_channels(images[1]->mean)};
}

struct Totals {
  double difference = 0, pixels = 0;
  std::array<double, 2> variance{}, spread{}, magnitude{};
};

Totals totals_of(const RegionGrid& pixels, const Images& images, std::array<int, 2> channels) {
  Totals total;
  total.pixels = double(pixels.size());
  for (double d : pixels.difference) total.difference += d;
  for (std::size_t k = 0; k < 2; ++k) {
    const PixelBuffer& mean = images[k]->mean;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      total.variance[k] += pixels.variance[k][i], total.spread[k] += pixels.spread[k][i];
      total.magnitude[k] += std::fabs(double(mean.values[i * mean.channels.size() + std::size_t(channels[k])]));
    }
  }
  return total;
}

std::array<double, 2> grain_of(const Totals& total, const Images& images) {
  std::array<double, 2> grain{};
  for (std::size_t k = 0; k < 2; ++k)
    if (total.magnitude[k] > 0 && std::isfinite(images[k]->degrees_of_freedom))
      grain[k] = total.variance[k] / total.magnitude[k];
  return grain;
}

// The image mean: for independent pixels from the sum of their variances, which has many degrees of freedom, and never
// less than the spread of the passes' own means.
Test image_test(const Totals& total, const Images& images, std::array<double, 2> grain, std::size_t channel) {
  double variance = 0, spread = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const EstimatedImage& image = *images[k];
    double of_sum = total.variance[k];
    if (image.error_of_mean) of_sum = std::max(of_sum, std::pow((*image.error_of_mean)[channel] * total.pixels, 2));
    const bool independent = !image.pixels_share_samples && total.spread[k] > 0;
    const double freedom =
        independent ? total.variance[k] * total.variance[k] / total.spread[k] : image.degrees_of_freedom;
    variance += of_sum, spread += of_sum * of_sum / freedom;
  }
  return {total.difference, variance, grain[total.difference < 0 ? 0 : 1],
          spread > 0 ? variance * variance / spread : infinity, total.pixels};
}

// The factor by which the spread of sums over pixels that share samples exceeds that of independent ones: according to
// the image means of the passes, and according to most blocks.
double correlation_of_passes(const Images& images, std::span<const Totals> totals) {
  double independent = 0, measured = 0;
  for (std::size_t c = 0; c < totals.size(); ++c)
    for (std::size_t k = 0; k < 2; ++k) {
      const double variance = totals[c].variance[k];
      const auto& error = images[k]->error_of_mean;
      independent += variance;
      measured += error && images[k]->pixels_share_samples ? std::pow((*error)[c] * totals[c].pixels, 2) : variance;
    }
  return independent > 0 && std::isfinite(measured) ? std::max(1.0, measured / independent) : 1.0;
}

double correlation_of_blocks(std::span<const GridTests> channels) {
  constexpr std::size_t enough = 24;
  constexpr double largest = 9;
  std::vector<double> squares;
  for (const GridTests& tests : channels)
    for (std::size_t i = 0; i < tests.size(); ++i)
      if (const double t = tests[i].t(); t != 0 && std::isfinite(t)) squares.push_back(t * t);
  if (squares.size() < enough) return 1;
  double factor = 1;
  // Quantiles of the square of a standard normal variable: for the median block, and for those that share more.
  for (const auto& [share, quantile] : {std::pair{0.5, 0.454936}, {0.9, 2.705543}}) {
    const auto at = squares.begin() + std::ptrdiff_t(share * double(squares.size()));
    std::nth_element(squares.begin(), at, squares.end());
    factor = std::max(factor, *at / quantile);
  }
  return std::min(factor, largest);
}

}  // namespace

WelchReport welch_test(const EstimatedImage& a, const EstimatedImage& b, double level) {
  assert(a.mean.width == b.mean.width && a.mean.height == b.mean.height);
  assert(a.mean.values.size() == a.standard_error.values.size());
  assert(b.mean.values.size() == b.standard_error.values.size());
  const Images images = {&a, &b};
  const auto places = channels_of(images);
  const int channels = a.mean.channel_count() < 3 ? 1 : 3;
  WelchReport report;
  Judge image(report.image), blocks(report.blocks), pixels(report.pixels);
  std::vector<RegionGrid> grids;  // of blocks, one per channel
  std::vector<Totals> totals;
  std::vector<std::array<double, 2>> grains;
  for (int c = 0; c < channels; ++c) {
    const std::array<int, 2> at = {places[0][std::size_t(c)], places[1][std::size_t(c)]};
    const RegionGrid grid = pixel_grid(a, b, at);
    totals.push_back(totals_of(grid, images, at));
    grains.push_back(grain_of(totals.back(), images));
    pixels.consider(GridTests(grid, images, grains.back(), pixel_radius), 1, c);
    image.consider(image_test(totals.back(), images, grains.back(), std::size_t(c)), 1, {0, 0}, c);
    grids.push_back(coarser(grid, block_size));
  }
  const bool correlated = a.pixels_share_samples || b.pixels_share_samples;
  double correlation = correlated ? correlation_of_passes(images, totals) : 1;
  while (true) {
    std::vector<GridTests> tests;
    for (std::size_t c = 0; c < grids.size(); ++c) tests.emplace_back(grids[c], images, grains[c], block_radius);
    if (correlated) correlation = std::max(correlation, correlation_of_blocks(tests));
    for (std::size_t c = 0; c < tests.size(); ++c) blocks.consider(tests[c], std::sqrt(correlation), int(c));
    if (grids.front().size() <= 4) break;
    for (RegionGrid& grid : grids) grid = coarser(grid, 2);
  }
  image.finish(level / 3), blocks.finish(level / 3), pixels.finish(level / 3);
  report.differs = report.image.differs || report.blocks.differs || report.pixels.differs;
  return report;
}

}  // namespace montelux
