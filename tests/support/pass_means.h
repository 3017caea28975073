// Means of the image and of its blocks in every pass: whatever correlation there is between the pixels of a pass, the
// passes are independent, and tests over them are honest.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {

// In pixels.
struct BlockSize {
  int width = 8, height = 8;
};

// By quantity (the image first, then blocks row by row), the values of all passes: of the mean of the components, which
// is what targets see, and of the image's colour, of which they know nothing.
struct PassMeans {
  std::vector<std::vector<double>> values;
  std::array<std::vector<double>, 2> colours;  // red less blue; green less the mean of these
  std::uint64_t non_finite = 0;
};

// Adds the film of one pass.
inline void add_pass(const Film& film, BlockSize block, PassMeans& m) {
  const PixelBounds& b = film.bounds();
  const int across = (b.width() + block.width - 1) / block.width, down = (b.height() + block.height - 1) / block.height;
  std::vector<double> sums(std::size_t(1 + across * down), 0.0), counts = sums;
  std::array<double, 2> colour{};
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      const auto& rgb = film.pixel(x, y).mean;
      const double value = mean_of_channels(rgb);
      colour[0] += rgb[0] - rgb[2], colour[1] += rgb[1] - 0.5 * (rgb[0] + rgb[2]);
      const auto of_block = std::size_t(1 + (y - b.y0) / block.height * across + (x - b.x0) / block.width);
      for (std::size_t i : {std::size_t(0), of_block}) sums[i] += value, counts[i] += 1;
    }
  m.values.resize(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) m.values[i].push_back(sums[i] / counts[i]);
  for (std::size_t i = 0; i < colour.size(); ++i) m.colours[i].push_back(colour[i] / counts[0]);
  m.non_finite += film.non_finite();
}

inline PassMeans measure_passes(const TestScene& scene, const ChosenIntegrator& chosen, int samples_per_pass,
                                int passes, std::uint32_t seed, BlockSize block = {}) {
  PassMeans m;
  RenderObserver silent;
  for (int pass = 0; pass < passes; ++pass) {
    RenderSettings s = scene.settings(PointSetKind::blue_noise, {samples_per_pass, 1}, seed, 0);
    s.plan.first_pass = pass;
    add_pass(render(chosen.any(), s, silent).film, block, m);
  }
  return m;
}

// The standard deviation of the image means of passes, relative to their mean.
inline double relative_spread(const PassMeans& m) {
  const SampleSummary image = summarize(m.values[0]);
  return std::sqrt(image.variance) / image.mean;
}

// Enough passes, at least `first`, for a comparison of two image means to have the relative standard error `wanted`.
// Two looks decide: `spread(passes)` measures the relative spread by so many passes, new ones at each call. The second
// look has as many as the first one requires, since a few passes do not show the spread of long tails.
template <class Spread>
int enough_passes(double wanted, int first, Spread&& spread) {
  int count = first;
  for (int look = 0; look < 2; ++look) {
    // Both sides of a comparison add to its error.
    const double ratio = spread(count) / (0.5 * wanted);
    const int needed = int(ratio * ratio) + 1;
    if (needed <= count) break;
    count = needed;
  }
  return count;
}

inline PassMeans measure_to(double wanted, const TestScene& scene, const ChosenIntegrator& chosen, int samples_per_pass,
                            std::uint32_t seed) {
  const auto measured = [&](int passes) { return measure_passes(scene, chosen, samples_per_pass, passes, seed++); };
  return measured(enough_passes(wanted, 48, [&](int passes) { return relative_spread(measured(passes)); }));
}

// Faults that leave the mean of the components as it is: light that has lost its colour, or has that of another
// component.
inline PassMeans without_colour(PassMeans m) {
  for (std::vector<double>& colour : m.colours) std::ranges::fill(colour, 0.0);
  return m;
}
inline PassMeans with_components_turned(PassMeans m) {
  for (std::size_t pass = 0; pass < m.values[0].size(); ++pass) {
    const double mean = m.values[0][pass], across = m.colours[0][pass], green = mean + m.colours[1][pass] * 2 / 3;
    const double red = (3 * mean - green + across) / 2, blue = red - across;
    m.colours[0][pass] = green - red, m.colours[1][pass] = blue - 0.5 * (green + red);
  }
  return m;
}

struct MeansVerdict {
  bool differ = false;
  double smallest_p = 1;
  double difference = 0;        // relative, where p is smallest
  std::size_t where = 0;        // 0: the image; else 1 + number of the block, and after these the two of colour
  double image_difference = 0;  // relative
  double image_error = 0;       // standard error of that
};

// Welch's test of every quantity, at a level for all of them together: half of it for the image, a quarter for its
// blocks, a quarter for its colour.
inline MeansVerdict compare_means(const PassMeans& a, const PassMeans& b, double level) {
  MeansVerdict v;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const SampleSummary x = summarize(a.values[i]), y = summarize(b.values[i]);
    if (i == 0) {
      v.image_difference = x.mean / y.mean - 1;
      v.image_error = std::hypot(x.standard_error(), y.standard_error()) / y.mean;
    }
    // Blocks of sky alone have negligible noise: they are equal up to rounding.
    if (std::abs(x.mean - y.mean) <= 1e-5 * std::abs(y.mean)) continue;
    const double p = welch_test(x, y).p_value;
    if (p < v.smallest_p) v.difference = x.mean / y.mean - 1;
    const double own = i == 0 ? 0.5 * level : sidak_level(0.25 * level, double(a.values.size() - 1));
    if (p < v.smallest_p) v.smallest_p = p, v.where = i;
    v.differ = v.differ || p < own;
  }
  const double image = summarize(b.values[0]).mean;
  for (std::size_t i = 0; i < a.colours.size(); ++i) {
    const SampleSummary x = summarize(a.colours[i]), y = summarize(b.colours[i]);
    if (std::abs(x.mean - y.mean) <= 1e-5 * image) continue;
    const double p = welch_test(x, y).p_value;
    if (p < v.smallest_p) v.smallest_p = p, v.where = a.values.size() + i, v.difference = (x.mean - y.mean) / image;
    v.differ = v.differ || p < sidak_level(0.25 * level, double(a.colours.size()));
  }
  return v;
}

// Passes of two integrators have the same means, which the test would not say of wrong colours.
inline void expect_same_means(const PassMeans& a, const PassMeans& b, double level) {
  const MeansVerdict verdict = compare_means(a, b, level);
  EXPECT_FALSE(verdict.differ) << verdict.smallest_p << " at " << verdict.where << ": " << verdict.difference;
  EXPECT_TRUE(compare_means(with_components_turned(a), b, level).differ);
  EXPECT_EQ(a.non_finite, 0u);
}

}  // namespace montelux::test
