// Images that are filtered in bands of rows: the same colours as of the whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "noisy_images.h"

namespace montelux {

namespace {

constexpr int images = 6, tall = images * height;

// Noisy images with layers, one below the other.
NoisyImage tall_image(unsigned seed) {
  NoisyImage all(width, tall);
  all.layers.assign(2, NoisyLayer(all.pixels(), true, "bounces"));
  for (unsigned k = 0; k < images; ++k) {
    std::array<ColorPlanes, 2> truths;
    const NoisyImage part = made_of_layers(seed + k, 0.5f, true, truths).image;
    const auto begin = std::ptrdiff_t(k) * std::ptrdiff_t(part.pixels());
    const auto put = [&](const auto& from, auto& to) {
      for (std::size_t c = 0; c < from.size(); ++c) std::ranges::copy(from[c], to[c].begin() + begin);
    };
    for (std::size_t h = 0; h < 2; ++h) {
      const HalfPlanes& half = part.halves[h];
      put(half.color, all.halves[h].color), put(half.albedo, all.halves[h].albedo);
      put(half.normal, all.halves[h].normal);
      std::ranges::copy(half.share, all.halves[h].share.begin() + begin);
      for (std::size_t l = 0; l < 2; ++l) put(part.layers[l].halves[h], all.layers[l].halves[h]);
    }
    put(part.variance, all.variance);
    for (std::size_t l = 0; l < 2; ++l) put(part.layers[l].variance, all.layers[l].variance);
  }
  return all;
}

float largest_difference(const ColorPlanes& a, const ColorPlanes& b) {
  float largest = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < a[c].size(); ++i) largest = std::max(largest, std::abs(a[c][i] - b[c][i]));
  return largest;
}

double mean_of(const ColorPlanes& planes) {
  double sum = 0;
  for (const Plane& plane : planes)
    for (float value : plane) sum += double(value);
  return sum / (3.0 * double(planes[0].size()));
}

}  // namespace

// Three bands, each of as many rows as the tiles over which errors are summed. Planted: the second one without the rows
// around it.
TEST(DenoiseInBands, has_the_colours_and_errors_of_the_whole_image) {
  const NoisyImage image = tall_image(5), earlier = tall_image(50);
  for (const bool has_others : {false, true}) {
    DenoiseSettings settings;
    if (has_others) settings.others = {&earlier, 1};
    const DenoisedImage whole = denoise(image, settings);
    settings.max_band = std::size_t(width) * 75;
    std::vector<int> rows;
    const DenoisedImage bands = denoise({width, tall,
                                         [&](const RowRange& range) {
                                           rows.push_back(range.count);
                                           return rows_of(image, range);
                                         }},
                                        settings);
    EXPECT_EQ(rows.size(), 3u);
    EXPECT_LT(*std::ranges::max_element(rows), 74 + 2 * 45);
    EXPECT_LT(largest_difference(bands.color, whole.color), 1e-5f);
    ASSERT_EQ(bands.layers.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_LT(largest_difference(bands.layers[k].color, whole.layers[k].color), 1e-5f);
      EXPECT_NEAR(mean_of(bands.layers[k].error) / mean_of(whole.layers[k].error), 1, 1e-5);
    }
    EXPECT_EQ(bands.sums.pixels, whole.sums.pixels);
    EXPECT_EQ(bands.sums.changed, whole.sums.changed);
    EXPECT_EQ(bands.sums.measured, whole.sums.measured);
    EXPECT_NEAR(bands.sums.noisy_mse() / whole.sums.noisy_mse(), 1, 1e-6);
    EXPECT_NEAR(bands.sums.mse() / whole.sums.mse(), 1, 1e-5);
    EXPECT_NEAR(bands.sums.relative_mse() / whole.sums.relative_mse(), 1, 1e-5);
    EXPECT_NEAR(bands.sums.relative_deviation() / whole.sums.relative_deviation(), 1, 1e-5);
    EXPECT_NEAR(mean_of(bands.error) / mean_of(whole.error), 1, 1e-5);
  }
  const DenoisedImage alone = denoise(rows_of(image, {74, 74})), whole = denoise(image);
  ColorPlanes expected;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto begin = whole.color[c].begin() + 74 * width;
    expected[c].assign(begin, begin + 74 * width);
  }
  EXPECT_GT(largest_difference(alone.color, expected), 1e-3f);
}

}  // namespace montelux
