// The removal of noise: its error is estimated without bias, and it keeps what it should.
#include "denoise/denoise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <span>
#include <utility>

#include "denoise/box_mean.h"
#include "denoise/relative_scale.h"
#include "denoise/reproject.h"
#include "denoise/squared_error.h"
#include "denoise/weighted_sums.h"
#include "mc/moments.h"
#include "noisy_images.h"

namespace montelux {

TEST(BoxMean, is_the_mean_over_the_pixels_that_exist) {
  std::mt19937 numbers(3);
  std::uniform_real_distribution<float> uniform;
  for (const auto& [w, h, reach] : {std::array{9, 7, 2}, {1, 5, 3}, {4, 1, 1}, {3, 3, 0}}) {
    Plane plane(std::size_t(w * h));
    for (float& x : plane) x = uniform(numbers);
    const Plane mean = box_mean(plane, w, h, reach);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        double sum = 0, count = 0;
        for (int v = std::max(y - reach, 0); v <= std::min(y + reach, h - 1); ++v)
          for (int u = std::max(x - reach, 0); u <= std::min(x + reach, w - 1); ++u)
            sum += double(plane[std::size_t(v * w + u)]), count += 1;
        EXPECT_NEAR(mean[std::size_t(y * w + x)], sum / count, 1e-6);
      }
  }
}

// A filter of fixed weights, with a bias, of two halves of unequal size: the mean over many draws of the estimate less
// the true squared error is zero. Without the covariance of the filter with its data it is not.
TEST(SquaredError, is_estimated_without_bias) {
  std::mt19937 numbers(11);
  std::normal_distribution<double> normal;
  constexpr double share = 0.3, variance = 0.7, value = 2, bias = 0.4, own_first = 0.35, own_second = 0.2;
  constexpr int draws = 400000;
  double sum = 0, square = 0, planted = 0;
  for (int i = 0; i < draws; ++i) {
    const double v1 = variance / share, v2 = variance / (1 - share);
    const Noisy data{value + std::sqrt(v1) * normal(numbers), value + std::sqrt(v2) * normal(numbers), share, variance};
    const double others = value + bias + 0.3 * normal(numbers);
    const Filtered f{own_first * data.first + (1 - own_first) * others,
                     own_second * data.second + (1 - own_second) * others, own_first, own_second};
    const double error = std::pow(share * f.first + (1 - share) * f.second - value, 2);
    const double difference = squared_error(data, f) - error;
    sum += difference, square += difference * difference;
    planted += squared_error(data, {f.first, f.second, 0, 0}) - error;
  }
  const double mean = sum / draws, deviation = std::sqrt((square / draws - mean * mean) / draws);
  EXPECT_LT(std::abs(mean), 4 * deviation);
  EXPECT_GT(std::abs(planted / draws), 10 * deviation);
}

// What the estimate of the error stands on.
TEST(FilterHalves, weights_do_not_depend_on_what_they_weigh) {
  const Made m = made(1);
  NoisyImage other = m.image;
  std::mt19937 numbers(5);
  std::normal_distribution<float> normal;
  for (Plane& plane : other.halves[0].color)
    for (float& x : plane) x += normal(numbers);
  const FilteredHalves a = filter_halves(m.image, {}), b = filter_halves(other, {});
  for (std::size_t k = 0; k < filter_count; ++k) {
    EXPECT_EQ(a[0][k].own, b[0][k].own);
    EXPECT_NE(a[0][k].color, b[0][k].color);
    EXPECT_NE(a[1][k].own, b[1][k].own);
  }
}

TEST(FilterHalves, weights_sum_to_one_at_edges_of_the_image_too) {
  Made m = made(1);
  for (HalfPlanes& half : m.image.halves)
    for (Plane& plane : half.color) std::ranges::fill(plane, 0.75f);
  for (const auto& half : filter_halves(m.image, {}))
    for (const FilteredHalf& one : half)
      for (const Plane& plane : one.color)
        for (float x : plane) ASSERT_NEAR(x, 0.75f, 1e-5f);
}

// Where colours follow the albedo, the normal and the place linearly, fits find them. Planted: means.
TEST(FilterHalves, fits_follow_features_and_gradients) {
  Made m = made(2);
  const int w = m.image.width;
  std::mt19937 numbers(3);
  std::uniform_real_distribution<float> uniform;
  ColorPlanes truth = m.truth;
  for (std::size_t i = 0; i < m.image.pixels(); ++i) {
    const float x = float(i % std::size_t(w)) / float(w), y = float(i / std::size_t(w)) / float(w);
    const float albedo = 0.3f + 0.3f * uniform(numbers), tilt = 0.4f * uniform(numbers);
    for (std::size_t c = 0; c < 3; ++c) truth[c][i] = (1 + float(c)) * (albedo + tilt + 0.3f * x - 0.2f * y);
    for (HalfPlanes& half : m.image.halves)
      for (std::size_t c = 0; c < 3; ++c) {
        half.albedo[c][i] = albedo, half.normal[c][i] = c == 0 ? tilt : 0;
        half.color[c][i] = truth[c][i];
      }
  }
  for (Plane& plane : m.image.variance) std::ranges::fill(plane, 1.0f);
  const FilteredHalves filtered = filter_halves(m.image, {});
  for (std::size_t k = 0; k < filter_count; ++k) {
    double error = 0, spread = 0;
    // At the edges the image is mirrored: gradients bend there.
    for (int y = filter_reach + 1; y < m.image.height - filter_reach - 1; ++y)
      for (int x = filter_reach + 1; x < w - filter_reach - 1; ++x)
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t i = std::size_t(y) * std::size_t(w) + std::size_t(x);
          error += square(double(filtered[0][k].color[c][i] - truth[c][i]));
          spread += (square(0.3) + square(0.4)) / 12 * square(1 + double(c));
        }
    if (k >= mean_count)
      EXPECT_LT(error, 0.02 * spread) << k;
    else
      EXPECT_GT(error, 0.5 * spread) << k;
  }
}

TEST(Denoise, states_the_error_of_the_image_and_of_the_result) {
  for (float share : {0.5f, 0.25f}) {
    double relative_stated = 0, relative_left = 0, stated = 0, left = 0;
    for (unsigned seed = 0; seed < 12; ++seed) {
      const Made m = made(seed, share);
      const DenoisedImage result = denoise(m.image);
      ColorPlanes before = m.truth;
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < before[c].size(); ++i) before[c][i] = mixed(m, c, i);
      double variance = 0;
      for (const Plane& plane : m.image.variance) variance += std::accumulate(plane.begin(), plane.end(), 0.0);
      EXPECT_NEAR(result.sums.noisy_mse(), variance / (3.0 * double(m.image.pixels())), 1e-6);
      const double error = mean_squared_error(result.color, m.truth);
      EXPECT_LT(error, 0.1 * mean_squared_error(before, m.truth));
      left += error, stated += result.sums.mse();
      relative_left += mean_relative_error(result.color, m.truth), relative_stated += result.sums.relative_mse();
    }
    // The choice of the least of several estimates lowers the stated error, the lower bound by the difference of the
    // halves raises it.
    EXPECT_GT(stated, 0.8 * left);
    EXPECT_LT(stated, 1.5 * left);
    EXPECT_GT(relative_stated, 0.9 * relative_left);
    EXPECT_LT(relative_stated, 1.6 * relative_left);
  }
}

// Where a tenth of the passes has all light, noise differs much from pixel to pixel. Planted: the sum of the errors of
// the layer, which has the greater of two noisy means in each small window.
TEST(Denoise, states_the_error_of_an_image_whose_noise_differs_from_pixel_to_pixel) {
  Moments off, planted_off;  // of what is stated from what is left
  std::mt19937 numbers(11);
  std::exponential_distribution<double> light(0.1);
  std::bernoulli_distribution is_lit(0.1);
  for (unsigned seed = 0; seed < 12; ++seed) {
    Made m = made(seed);
    constexpr int passes = 8;  // of each half
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < m.image.pixels(); ++i) {
        double sum = 0, squares = 0;
        for (HalfPlanes& half : m.image.halves) {
          double of_half = 0;
          for (int pass = 0; pass < passes; ++pass) {
            const double value = is_lit(numbers) ? double(m.truth[c][i]) * light(numbers) : 0;
            of_half += value, squares += square(value);
          }
          half.color[c][i] = float(of_half / passes), sum += of_half;
        }
        constexpr double n = 2 * passes;
        m.image.variance[c][i] = float((squares - sum * sum / n) / (n * (n - 1)));
      }
    const DenoisedImage result = denoise(m.image);
    const double left = mean_relative_error(result.color, m.truth);
    double planted = 0;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < m.image.pixels(); ++i)
        planted +=
            double(square(result.error[c][i]) * reciprocal_square(result.color[c][i])) / double(3 * m.image.pixels());
    off.add(result.sums.relative_mse() - left), planted_off.add(planted - left);
  }
  EXPECT_LT(std::abs(off.mean), 3 * off.standard_error());
  EXPECT_GT(planted_off.mean, 4 * planted_off.standard_error());
}

// The spread of what is stated around the truth, in the deviations that are stated with it.
TEST(Denoise, knows_how_uncertain_the_stated_error_is) {
  constexpr unsigned seeds = 40;
  double squares = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const Made m = made(seed);
    const DenoisedImage result = denoise(m.image);
    const double off = result.sums.relative_mse() - mean_relative_error(result.color, m.truth);
    squares += off * off / (result.sums.relative_deviation() * result.sums.relative_deviation()) / seeds;
    EXPECT_GT(result.sums.unfiltered_relative_mse(), 0);
    EXPECT_LT(result.sums.unfiltered_relative_mse(), result.sums.noisy_relative_mse());
  }
  // Deviations that were half or twice as large would be out of this range.
  EXPECT_GT(std::sqrt(squares), 0.65);
  EXPECT_LT(std::sqrt(squares), 1.3);
}

TEST(Denoise, keeps_edges_that_only_the_colours_show) {
  const Made m = made(2, 0.5f, {0.02, 0.02, 0.02});
  const DenoisedImage result = denoise(m.image);
  for (int y = 4; y < 12; ++y) {
    const auto dark = std::size_t(y * width + 24), bright = dark + 1;
    EXPECT_NEAR(result.color[0][dark], m.truth[0][dark], 0.06);
    EXPECT_NEAR(result.color[0][bright], m.truth[0][bright], 0.06);
  }
}

// A lamp that a few samples of each pixel hit, before nothing.
NoisyImage lamp_before_darkness(bool is_before_surface) {
  NoisyImage image(width, height);
  std::mt19937 numbers(5);
  constexpr int samples = 32;  // of a half
  constexpr double part = 0.02, radiance = 150;
  std::binomial_distribution<int> hits(samples, part);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto i = std::size_t(y * width + x);
      const bool shows_lamp = std::abs(x - 30) <= 2 && std::abs(y - 18) <= 1;
      double variance = 0;
      for (HalfPlanes& half : image.halves) {
        half.share[i] = 0.5f;
        const double share = shows_lamp ? hits(numbers) / double(samples) : 0;
        for (Plane& plane : half.color) plane[i] = float(share * radiance);
        half.normal[2][i] = is_before_surface || share > 0 ? 1.0f : 0.0f;
        variance += share * (1 - share) * radiance * radiance / samples / 4;
      }
      for (Plane& plane : image.variance) plane[i] = float(variance);
    }
  return image;
}

// The largest brightness of pixels that neither show a surface nor have a neighbour that does.
float brightest_beyond(const NoisyImage& image, const ColorPlanes& color) {
  float brightest = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (std::abs(x - 30) > 3 || std::abs(y - 18) > 2)
        brightest = std::max(brightest, color[0][std::size_t(y * image.width + x)]);
  return brightest;
}

// Planted: a surface behind the lamp, which light might reach.
TEST(Denoise, spreads_no_light_to_where_there_is_no_surface) {
  const NoisyImage image = lamp_before_darkness(false), planted = lamp_before_darkness(true);
  EXPECT_EQ(brightest_beyond(image, denoise(image).color), 0);
  EXPECT_GT(brightest_beyond(planted, denoise(planted).color), 1e-3f);
}

// One bright sample makes its own pixel look like any other; the others must not take it for one of theirs.
TEST(Denoise, does_not_spread_a_rare_bright_sample_by_its_own_variance) {
  Made m = made(4);
  constexpr std::size_t at = 12 * width + 40;
  for (std::size_t c = 0; c < 3; ++c) {
    m.image.halves[0].color[c][at] = 400;
    m.image.variance[c][at] = 200 * 200;
  }
  const DenoisedImage result = denoise(m.image);
  for (int dy = -7; dy <= 7; ++dy)
    for (int dx = -7; dx <= 7; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const auto i = std::size_t(int(at) + dy * width + dx);
      ASSERT_NEAR(result.color[1][i], m.truth[1][i], 2) << dx << " " << dy;
    }
  EXPECT_LT(result.color[1][at], 150);
}

TEST(Denoise, leaves_pixels_alone_that_have_no_two_halves_or_no_noise) {
  Made m = made(6);
  for (std::size_t i = 0; i < m.image.pixels(); i += 7)
    for (HalfPlanes& half : m.image.halves) {
      half.share[i] = 1;
      for (Plane& plane : half.color) plane[i] = 5;
    }
  const DenoisedImage result = denoise(m.image);
  for (std::size_t i = 0; i < m.image.pixels(); i += 7) EXPECT_EQ(result.color[0][i], 5);

  Made exact = made(6, 0.5f, {0, 0, 0});
  const DenoisedImage same = denoise(exact.image);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < exact.image.pixels(); ++i) ASSERT_NEAR(same.color[c][i], exact.truth[c][i], 1e-4f);
  EXPECT_NEAR(same.sums.mse(), 0, 1e-8);
}

// Noise of the features is none of the surfaces: it does not keep pixels apart. Planted: noise that both halves share
// looks like a texture.
TEST(Denoise, knows_the_noise_of_the_features) {
  double with_noise = 0, without = 0, planted = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Made exact = made(seed);
    Made noisy = exact, fault = exact;
    std::mt19937 numbers(100 + seed);
    std::normal_distribution<float> normal(0, 0.15f);
    for (std::size_t i = 0; i < exact.image.pixels(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t h = 0; h < 2; ++h) {
          noisy.image.halves[h].albedo[c][i] += normal(numbers);
          fault.image.halves[h].albedo[c][i] = noisy.image.halves[0].albedo[c][i];
        }
    without += mean_squared_error(denoise(exact.image).color, exact.truth);
    with_noise += mean_squared_error(denoise(noisy.image).color, exact.truth);
    planted += mean_squared_error(denoise(fault.image).color, exact.truth);
  }
  EXPECT_LT(with_noise, 1.5 * without);
  EXPECT_GT(planted, 1.8 * without);
}

// A fit through a few bright pixels may be below zero beside them. Planted: fits as they are.
TEST(Denoise, has_no_light_below_zero) {
  Made m = made(3);
  std::mt19937 numbers(7);
  std::exponential_distribution<float> light(1);
  for (std::size_t i = 0; i < m.image.pixels(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const float rare = i % 29 == 0 ? 40.0f : 0.0f;
      for (HalfPlanes& half : m.image.halves) half.color[c][i] = 1e-3f + rare * square(light(numbers));
      m.image.variance[c][i] = 0.25f * square(m.image.halves[0].color[c][i] - m.image.halves[1].color[c][i]);
    }
  const auto least = [](const ColorPlanes& color) {
    float value = 0;
    for (const Plane& plane : color) value = std::min(value, *std::ranges::min_element(plane));
    return value;
  };
  EXPECT_GT(least(denoise(m.image).color), -1e-6f);  // rounding
  float planted = 0;
  for (const auto& half : filter_halves(m.image, {}))
    for (const FilteredHalf& one : half) planted = std::min(planted, least(one.color));
  EXPECT_LT(planted, -0.01f);
}

// One rare bright sample has the light of many pixels. No part of it may be left where it was met because pixels
// around it keep a part of theirs: that would be 0.15 of it.
TEST(Denoise, leaves_nothing_of_one_bright_sample) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    Made m = made(seed);
    const DenoisedImage before = denoise(m.image);
    const std::size_t at =
        std::size_t(m.image.height / 2) * std::size_t(m.image.width) + std::size_t(m.image.width / 2);
    constexpr float bright = 1e4f;
    for (std::size_t c = 0; c < 3; ++c) {
      m.image.halves[0].color[c][at] += bright;
      // Of one pass of few, all others of which are dark.
      m.image.variance[c][at] += square(bright * m.image.halves[0].share[at]);
    }
    const DenoisedImage after = denoise(m.image);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(std::abs(after.color[c][at] - before.color[c][at]), 0.05f * bright);
  }
}

// Another image helps where it shows the same, and does little harm where it shows something else that noise hides.
TEST(Denoise, takes_other_images_only_where_they_lower_the_error) {
  double alone = 0, with_same = 0, with_other = 0;
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Made m = made(seed);
    Made same = made(seed + 50), other = same;
    for (HalfPlanes& half : other.image.halves)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < m.image.pixels(); ++i) half.color[c][i] += std::sqrt(m.image.variance[c][i]);
    const auto error_with = [&](std::span<const NoisyImage> others) {
      DenoiseSettings settings;
      settings.others = others;
      return mean_squared_error(denoise(m.image, settings).color, m.truth);
    };
    alone += error_with({}), with_same += error_with({&same.image, 1}), with_other += error_with({&other.image, 1});
  }
  EXPECT_LT(with_same, 0.8 * alone);
  EXPECT_LT(with_other, 1.25 * alone);
}

// Stripes of a texture that the noise of the colours hides. Planted: without the albedo they are blurred.
TEST(Denoise, keeps_the_edges_of_a_texture) {
  Made m = made(3, 0.5f, {0.4, 0.4, 0.4});
  for (std::size_t i = 0; i < m.image.pixels(); ++i) {
    const float factor = (i % width) / 4 % 2 == 0 ? 1.0f : 0.6f;
    for (std::size_t c = 0; c < 3; ++c) {
      m.truth[c][i] *= factor, m.image.variance[c][i] *= factor * factor;
      for (HalfPlanes& half : m.image.halves) half.color[c][i] *= factor, half.albedo[c][i] = 0.8f * factor;
    }
  }
  Made blind = m;
  for (HalfPlanes& half : blind.image.halves)
    for (Plane& plane : half.albedo) std::ranges::fill(plane, 0.5f);
  const double seen = mean_squared_error(denoise(m.image).color, m.truth);
  EXPECT_GT(mean_squared_error(denoise(blind.image).color, m.truth), 1.7 * seen);
}

TEST(Denoise, averages_over_other_images_too) {
  double alone = 0, together = 0, stated = 0;
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Made m = made(seed), earlier = made(200 + seed);
    alone += mean_squared_error(denoise(m.image).color, m.truth);
    const DenoisedImage result = denoise(m.image, {0, {}, {&earlier.image, 1}});
    together += mean_squared_error(result.color, m.truth), stated += result.sums.mse();
  }
  EXPECT_LT(together, 0.85 * alone);
  EXPECT_GT(stated, 0.7 * together);
  EXPECT_LT(stated, 1.6 * together);
}

// Another image that shows something else is not taken in: a shadow has moved.
TEST(Denoise, leaves_out_what_other_images_do_not_share) {
  const Made m = made(5);
  Made other = made(205);
  for (HalfPlanes& half : other.image.halves)
    for (std::size_t c = 0; c < 3; ++c)
      for (float& x : half.color[c]) x = 3 - x;
  const double alone = mean_squared_error(denoise(m.image).color, m.truth);
  EXPECT_LT(mean_squared_error(denoise(m.image, {0, {}, {&other.image, 1}}).color, m.truth), 1.2 * alone);
}

TEST(Reprojected, pixels_are_those_that_showed_the_same) {
  std::array<ColorPlanes, 2> truths;
  const Made m = made_of_layers(1, 0.5f, true, truths);
  MotionPlanes motion{Plane(m.image.pixels(), 3.2f), Plane(m.image.pixels(), -1.9f)};
  const NoisyImage there = reprojected(m.image, motion);
  const MotionPlanes twice = composed(motion, motion, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto i = std::size_t(y * width + x), from = std::size_t((y + 2) * width + x + 3);
      const bool inside = x + 3 < width && y + 2 < height;
      ASSERT_EQ(there.halves[0].share[i] > 0, inside);
      ASSERT_EQ(std::isfinite(twice.x[i]), inside);
      if (!inside) continue;
      ASSERT_EQ(there.halves[1].color[2][i], m.image.halves[1].color[2][from]);
      ASSERT_EQ(there.halves[0].albedo[1][i], m.image.halves[0].albedo[1][from]);
      ASSERT_EQ(there.variance[0][i], m.image.variance[0][from]);
      ASSERT_EQ(there.layers[1].halves[0][2][i], m.image.layers[1].halves[0][2][from]);
      ASSERT_EQ(there.layers[0].variance[1][i], m.image.layers[0].variance[1][from]);
      ASSERT_FLOAT_EQ(twice.x[i], 6.4f);
      ASSERT_FLOAT_EQ(twice.y[i], -3.8f);
    }
}

TEST(Denoise, has_the_same_bits_for_any_number_of_threads) {
  std::array<ColorPlanes, 2> truths;
  const Made m = made_of_layers(8, 0.5f, true, truths);
  const DenoisedImage one = denoise(m.image, {1, {}});
  for (int threads : {2, 3}) {
    const DenoisedImage other = denoise(m.image, {threads, {}});
    EXPECT_EQ(one.color, other.color);
    EXPECT_EQ(one.error, other.error);
    EXPECT_EQ(one.sums.relative_mse(), other.sums.relative_mse());
    EXPECT_EQ(one.layers[1].color, other.layers[1].color);
    EXPECT_EQ(one.layers[1].error, other.layers[1].error);
  }
}

TEST(Denoise, can_be_stopped) {
  EXPECT_THROW(denoise(made(8).image, {1, [] { return true; }}), std::runtime_error);
}

}  // namespace montelux
