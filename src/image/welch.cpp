#include "image/welch.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "math/special.h"

namespace montelux {
namespace {

constexpr int block_size = 8;

// Sums over a region: of the differences, of their variances, and of what Satterthwaite's formula divides by.
struct Region {
  double difference = 0.0;
  double variance = 0.0;
  double spread = 0.0;
  std::size_t count = 0;

  void add(const Region& other) {
    difference += other.difference;
    variance += other.variance;
    spread += other.spread;
    count += other.count;
  }
};

struct Comparison {
  double p, t, difference, standard_error, degrees_of_freedom;
};

Comparison compare(const Region& region) {
  double n = double(region.count);
  Comparison c{1.0, 0.0, region.difference / n, std::sqrt(region.variance) / n, 1.0};
  c.degrees_of_freedom =
      region.spread > 0.0 ? region.variance * region.variance / region.spread : std::numeric_limits<double>::infinity();
  if (!std::isfinite(region.difference) || !std::isfinite(region.variance)) {
    c.p = 0.0;
  } else if (region.variance > 0.0) {
    c.t = c.difference / c.standard_error;
    c.p = 2.0 * special::student_t_tail(std::fabs(c.t), c.degrees_of_freedom);
  } else if (region.difference != 0.0) {
    c.t = std::copysign(std::numeric_limits<double>::infinity(), region.difference);
    c.p = 0.0;
  }
  return c;
}

Region pixel_region(const EstimatedImage& a, const EstimatedImage& b, std::size_t i, std::size_t j) {
  double difference = double(a.mean.values[i]) - double(b.mean.values[j]);
  double va = std::pow(double(a.standard_error.values[i]), 2), vb = std::pow(double(b.standard_error.values[j]), 2);
  return {difference, va + vb, va * va / a.degrees_of_freedom + vb * vb / b.degrees_of_freedom, 1};
}

// Takes one more test of a scale into account. The first one sets the record, whatever it is.
void consider(WelchScale& scale, Comparison& best, const Region& region, int x, int y, int channel) {
  Comparison c = compare(region);
  ++scale.tests;
  bool more = c.p < scale.smallest_p || (c.p == scale.smallest_p && std::fabs(c.t) > std::fabs(scale.t));
  if (scale.tests > 1 && !more) return;
  best = c;
  scale.smallest_p = c.p;
  scale.t = c.t;
  scale.difference = c.difference;
  scale.x = x;
  scale.y = y;
  scale.channel = channel;
}

void judge(WelchScale& scale, const Comparison& best, double level) {
  double share = level / double(scale.tests);
  scale.differs = scale.smallest_p < share;
  scale.detectable = best.standard_error > 0.0
                         ? -special::student_t_quantile(0.5 * share, best.degrees_of_freedom) * best.standard_error
                         : 0.0;
}

}  // namespace

WelchReport welch_test(const EstimatedImage& a, const EstimatedImage& b, double level) {
  int width = a.mean.width, height = a.mean.height;
  assert(width == b.mean.width && height == b.mean.height);
  assert(a.mean.values.size() == a.standard_error.values.size());
  assert(b.mean.values.size() == b.standard_error.values.size());
  std::array<int, 3> a_channels = rgb_channels(a.mean), b_channels = rgb_channels(b.mean);
  WelchReport report;
  Comparison best_image{}, best_block{}, best_pixel{};
  int channels = a.mean.channel_count() < 3 ? 1 : 3;
  for (int c = 0; c < channels; ++c) {
    int ac = a_channels[std::size_t(c)], bc = b_channels[std::size_t(c)];
    Region whole;
    for (int y0 = 0; y0 < height; y0 += block_size)
      for (int x0 = 0; x0 < width; x0 += block_size) {
        Region block;
        for (int y = y0; y < std::min(y0 + block_size, height); ++y)
          for (int x = x0; x < std::min(x0 + block_size, width); ++x) {
            Region pixel = pixel_region(a, b, a.mean.index(x, y, ac), b.mean.index(x, y, bc));
            consider(report.pixels, best_pixel, pixel, x, y, c);
            block.add(pixel);
          }
        consider(report.blocks, best_block, block, x0, y0, c);
        whole.add(block);
      }
    consider(report.image, best_image, whole, 0, 0, c);
  }
  judge(report.image, best_image, level / 3.0);
  judge(report.blocks, best_block, level / 3.0);
  judge(report.pixels, best_pixel, level / 3.0);
  report.differs = report.image.differs || report.blocks.differs || report.pixels.differs;
  return report;
}

}  // namespace montelux
