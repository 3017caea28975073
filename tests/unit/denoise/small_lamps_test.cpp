// Lamps of few pixels: their light is not spread over what is around them, and its noise is part of the stated error.
#include "denoise/small_lamps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace montelux {

namespace {

constexpr int width = 40, height = 33, lamp_x = 20, lamp_y = 15;
constexpr int samples = 8;  // of a half
constexpr double wall = 0.2;

std::size_t at(int x, int y) { return std::size_t(y * width + x); }

// The share of a pixel that the lamp covers.
double coverage(int x, int y) {
  const int dx = x - lamp_x, dy = y - lamp_y;
  if (dy == 0) return dx == 0 ? 0.4 : dx == 1 ? 0.15 : 0;
  return dy == 1 && dx == 0 ? 0.1 : 0;
}

// Of a lamp that most halves of the samples miss.
double coverage_of_speck(int x, int y) { return x == lamp_x && y == lamp_y ? 0.06 : 0; }

double truth(int x, int y, std::size_t c, double lamp) {
  const double p = coverage(x, y), color = 1 + 0.5 * double(c);
  return p * lamp * color + (1 - p) * wall;
}

// A wall with a lamp before it: each sample sees one of the two. Two layers, emission and the rest.
NoisyImage made(unsigned seed, double lamp, double (*covered)(int, int) = coverage) {
  NoisyImage image(width, height);
  image.layers.assign(2, NoisyLayer(image.pixels(), true));
  std::mt19937 numbers(seed);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = at(x, y);
      std::array<std::array<double, 3>, 3> sum{}, square{};  // of all light and of the layers, by channel
      for (std::size_t h = 0; h < 2; ++h) {
        HalfPlanes& half = image.halves[h];
        half.share[i] = 0.5f;
        for (int s = 0; s < samples; ++s) {
          const bool is_lamp = uniform(numbers) < covered(x, y);
          const double gray = wall * (1 + 0.3 * normal(numbers));
          for (std::size_t c = 0; c < 3; ++c) {
            const double emitted = is_lamp ? lamp * (1 + 0.5 * double(c)) : 0, rest = is_lamp ? 0 : gray;
            half.color[c][i] += float((emitted + rest) / samples), half.emission[c][i] += float(emitted / samples);
            image.layers[0].halves[h][c][i] += float(emitted / samples);
            image.layers[1].halves[h][c][i] += float(rest / samples);
            const std::array values{emitted + rest, emitted, rest};
            for (std::size_t k = 0; k < 3; ++k) sum[k][c] += values[k], square[k][c] += values[k] * values[k];
          }
        }
        for (std::size_t c = 0; c < 3; ++c) half.albedo[c][i] = 0.5f, half.normal[c][i] = c == 2 ? 1.0f : 0.0f;
      }
      constexpr double n = 2 * samples;
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < 3; ++k) {
          const double variance = (square[k][c] - sum[k][c] * sum[k][c] / n) / (n - 1) / n;
          (k == 0 ? image.variance : image.layers[k - 1].variance)[c][i] = float(std::max(variance, 0.0));
        }
    }
  return image;
}

// Without what the camera sees of emitters.
NoisyImage blind(NoisyImage image) {
  for (HalfPlanes& half : image.halves)
    for (Plane& plane : half.emission) std::ranges::fill(plane, 0.0f);
  return image;
}

// The mean relative error of the pixels that show the wall alone.
double error_of_wall(const DenoisedImage& image, double lamp) {
  double sum = 0, count = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (coverage(x, y) > 0) continue;
      for (std::size_t c = 0; c < 3; ++c, ++count)
        sum += std::pow(double(image.color[c][at(x, y)]) / truth(x, y, c, lamp) - 1, 2);
    }
  return sum / count;
}

}  // namespace

TEST(SmallLamps, are_the_emission_that_is_far_brighter_than_what_is_around_it) {
  EXPECT_FALSE(split_small_lamps(made(1, 100)).has_value());
  EXPECT_FALSE(split_small_lamps(blind(made(1, 5000))).has_value());
  const NoisyImage image = made(1, 5000);
  const std::optional<SplitImage> split = split_small_lamps(image);
  ASSERT_TRUE(split.has_value());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (std::size_t c = 0, i = at(x, y); c < 3; ++c) {
        for (std::size_t h = 0; h < 2; ++h) {
          const HalfPlanes &whole = image.halves[h], &rest = split->rest.halves[h];
          const float kept = split->kept.halves[h][c][i];
          ASSERT_FLOAT_EQ(rest.color[c][i] + kept, whole.color[c][i]);
          // The colour of a lamp's pixel in floats has few digits for the wall behind.
          ASSERT_NEAR(kept, whole.emission[c][i], 1e-6f * whole.color[c][i]);
          for (std::size_t k = 0; k < 2; ++k)
            ASSERT_FLOAT_EQ(split->rest.layers[k].halves[h][c][i] + split->kept_layers[k].halves[h][c][i],
                            image.layers[k].halves[h][c][i]);
        }
        const double sum = double(split->rest.variance[c][i]) + double(split->kept.variance[c][i]) +
                           2 * double(split->kept.covariance[c][i]);
        ASSERT_NEAR(sum, image.variance[c][i], 1e-3 * double(image.variance[c][i]) + 1e-12);
      }
}

// Planted: without the emission the lamp is spread, as any noise is.
TEST(SmallLamps, are_not_spread_over_what_is_around_them) {
  double seen = 0, planted = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const NoisyImage image = made(seed, 5000);
    const DenoisedImage result = denoise(image);
    const double error = error_of_wall(result, 5000);
    EXPECT_LT(error, 0.09 / (2 * samples) / 3);  // a third of the error of the noise
    seen += error, planted += error_of_wall(denoise(blind(image)), 5000);
    // Layers still sum to the image.
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < image.pixels(); ++i)
        ASSERT_NEAR(result.layers[0].color[c][i] + result.layers[1].color[c][i], result.color[c][i],
                    1e-5f * (1 + result.color[c][i]));
  }
  EXPECT_GT(planted, 1000 * seen);
}

// The error of the lamp is that of its samples. Planted: an estimate from the filtered light alone.
TEST(SmallLamps, have_their_noise_in_the_stated_error) {
  constexpr double lamp = 5000;
  constexpr int seeds = 400;
  double sum = 0, square = 0, left = 0, planted = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    NoisyImage image = made(seed, lamp);
    image.layers.clear();
    const DenoisedImage result = denoise(image);
    double error = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          error += std::pow(double(result.color[c][at(x, y)]) - truth(x, y, c, lamp), 2) / (3.0 * width * height);
    const double difference = result.sums.mse() - error;
    sum += difference, square += difference * difference, left += error;
    planted += denoise(split_small_lamps(image)->rest).sums.mse();
  }
  const double mean = sum / seeds, deviation = std::sqrt((square / seeds - mean * mean) / seeds);
  EXPECT_LT(std::abs(mean), 4 * deviation);
  EXPECT_LT(4 * deviation, 0.25 * left / seeds);
  EXPECT_LT(planted, 0.5 * left);
}

// Planted: without the emission of the other image. The choice of filters leaves little of that fault: it shows where
// the lamp is bright.
TEST(SmallLamps, of_other_images_are_not_spread) {
  constexpr double lamp = 500000;
  double seen = 0, planted = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const NoisyImage image = made(seed, lamp), other = made(seed + 50, lamp, coverage_of_speck), fault = blind(other);
    const auto error_with = [&](const NoisyImage& one) {
      return error_of_wall(denoise(image, {0, {}, {&one, 1}}), lamp);
    };
    seen += error_with(other), planted += error_with(fault);
    EXPECT_LT(error_with(other), 0.09 / (2 * samples) / 3);
  }
  EXPECT_GT(planted, 1.2 * seen);
}

}  // namespace montelux
