#include "image/welch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "math/special.h"
#include "mc/random.h"

namespace montelux {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Estimate {
  PixelBuffer mean, error;
  int passes;

  EstimatedImage view() const { return {mean, error, double(passes - 1)}; }
};

// Means of normal samples about the value that truth gives, and their standard errors.
template <class Truth>
Estimate estimate(int passes, std::uint32_t seed, Truth truth) {
  Estimate e{make_pixel_buffer(32, 24, {"R", "G", "B"}), make_pixel_buffer(32, 24, {"R", "G", "B"}), passes};
  RandomStream<float> random(seed, 77u);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x)
      for (int c = 0; c < 3; ++c) {
        double mean = 0.0, m2 = 0.0;
        for (int n = 1; n <= passes; ++n) {
          double sample = truth(x, y) + special::normal_quantile(double(random.next()) + 0x1p-26);
          double delta = sample - mean;
          mean += delta / n;
          m2 += delta * (sample - mean);
        }
        e.mean.at(x, y, c) = float(mean);
        e.error.at(x, y, c) = float(std::sqrt(m2 / (passes * (passes - 1.0))));
      }
  return e;
}

TEST(Welch, estimates_of_the_same_image_do_not_differ) {
  auto truth = [](int x, int y) { return 0.1 * x + y; };
  // Twenty comparisons at a family-wise level of 1e-3.
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    Estimate a = estimate(8, 2 * seed, truth), b = estimate(12, 2 * seed + 1, truth);
    WelchReport report = welch_test(a.view(), b.view(), 1e-3 / 20);
    EXPECT_FALSE(report.differs) << report.image.smallest_p << ' ' << report.blocks.smallest_p;
    EXPECT_EQ(report.image.tests, 3u);
    EXPECT_EQ(report.blocks.tests, 3u * (4 * 3 + 2 * 2));
    EXPECT_EQ(report.pixels.tests, 3u * 32 * 24);
  }
}

TEST(Welch, a_small_bias_everywhere_is_found_in_the_mean_alone) {
  Estimate a = estimate(16, 1, [](int, int) { return 0.0; });
  Estimate b = estimate(16, 2, [](int, int) { return 0.1; });
  WelchReport report = welch_test(a.view(), b.view(), 1e-3);
  EXPECT_TRUE(report.image.differs);
  EXPECT_FALSE(report.pixels.differs);
  // A difference of -0.1 lies within the error bar that the report states, one of -0.2 far outside.
  const double error = report.image.difference / report.image.t;
  EXPECT_LT(std::abs(report.image.difference + 0.1), special::normal_quantile(0.9995) * error);
  EXPECT_GT(std::abs(report.image.difference + 0.2), special::normal_quantile(0.9995) * error);
  EXPECT_LT(report.image.detectable, 0.1);
}

TEST(Welch, a_dark_block_is_found_in_the_blocks_and_said_where) {
  Estimate a = estimate(16, 3, [](int, int) { return 1.0; });
  Estimate b = estimate(16, 4, [](int x, int y) { return x / 8 == 2 && y / 8 == 1 ? 0.5 : 1.0; });
  WelchReport report = welch_test(a.view(), b.view(), 1e-3);
  EXPECT_TRUE(report.blocks.differs);
  EXPECT_EQ(report.blocks.x, 16);
  EXPECT_EQ(report.blocks.y, 8);
}

TEST(Welch, one_wrong_pixel_is_found_in_the_pixels_and_said_where) {
  Estimate a = estimate(16, 5, [](int, int) { return 1.0; });
  Estimate b = estimate(16, 6, [](int x, int y) { return x == 7 && y == 20 ? 9.0 : 1.0; });
  WelchReport report = welch_test(a.view(), b.view(), 1e-3);
  EXPECT_TRUE(report.pixels.differs);
  EXPECT_EQ(report.pixels.x, 7);
  EXPECT_EQ(report.pixels.y, 20);
  a.mean.at(3, 4, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(welch_test(a.view(), b.view(), 1e-3).pixels.smallest_p, 0.0);
}

TEST(Welch, a_known_image_is_tested_as_by_the_one_sample_t_test) {
  PixelBuffer mean = make_pixel_buffer(1, 1, {"Y"}), error = mean, truth = mean, zero = mean;
  mean.values = {1.5f};
  error.values = {0.5f};
  truth.values = {0.25f};
  WelchReport report = welch_test({mean, error, 5.0}, {truth, zero, infinity}, 0.05);
  EXPECT_NEAR(report.pixels.t, 2.5, 1e-12);
  // Two-sided p of t = 2.5 with 5 degrees of freedom, from the closed form of the t distribution for odd degrees.
  double theta = std::atan(2.5 / std::sqrt(5.0)), c = std::cos(theta), s = std::sin(theta);
  double p = 1.0 - 2.0 / 3.14159265358979324 * (theta + s * (c + 2.0 / 3.0 * c * c * c));
  EXPECT_NEAR(report.pixels.smallest_p, p, 1e-12);
  WelchReport same = welch_test({truth, zero, infinity}, {truth, zero, infinity}, 0.05);
  EXPECT_EQ(same.pixels.smallest_p, 1.0);
  EXPECT_TRUE(welch_test({mean, zero, infinity}, {truth, zero, infinity}, 0.05).differs);
}

// Means over passes of pixels whose samples are rarely bright, as of a lamp that few paths find.
Estimate rare_light(int samples, int passes, std::uint32_t seed, double scale = 1.0) {
  constexpr int width = 40, height = 32;
  constexpr float chance = 0.004f;
  const auto buffer = [] { return make_pixel_buffer(width, height, {"R", "G", "B"}); };
  Estimate e{buffer(), buffer(), passes};
  RandomStream<float> random(seed, 78u);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double mean = 0.0, m2 = 0.0;
      for (int n = 1; n <= passes; ++n) {
        double pass = 0;
        for (int i = 0; i < samples / passes; ++i)
          pass += 0.1 + 0.02 * double(random.next()) + (random.next() < chance ? 30.0 : 0.0);
        pass *= scale * double(passes) / samples;
        const double delta = pass - mean;
        mean += delta / n;
        m2 += delta * (pass - mean);
      }
      for (int c = 0; c < 3; ++c) {
        e.mean.at(x, y, c) = float(mean);
        e.error.at(x, y, c) = float(std::sqrt(m2 / (passes * (passes - 1.0))));
      }
    }
  return e;
}

TEST(Welch, rare_bright_samples_make_no_difference_of_unequal_numbers_of_samples) {
  // At level 1 %, more than 4 of 60 come with probability 3e-4.
  int differ = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Estimate few = rare_light(16, 8, 3 * seed), more = rare_light(64, 8, 3 * seed + 1),
                   many = rare_light(512, 16, 3 * seed + 2);
    for (const auto& [a, b] : {std::pair{&few, &more}, {&few, &many}, {&more, &many}})
      differ += welch_test(a->view(), b->view(), 0.01).differs ? 1 : 0;
  }
  EXPECT_LE(differ, 4);
}

TEST(Welch, a_difference_twice_the_detectable_one_is_found_among_rare_bright_samples) {
  const WelchReport alike = welch_test(rare_light(256, 16, 100).view(), rare_light(1024, 16, 101).view(), 0.01);
  const double mean = 0.11 + 0.004 * 30;
  const double share = 2 * alike.image.detectable / mean;
  EXPECT_LT(share, 0.2);
  const Estimate a = rare_light(256, 16, 102), brighter = rare_light(1024, 16, 103, 1 + share);
  EXPECT_TRUE(welch_test(a.view(), brighter.view(), 0.01).image.differs);
}

TEST(Welch, the_detectable_difference_is_found_in_half_of_the_cases) {
  const auto about = [](std::uint32_t seed, double value) {
    return estimate(16, seed, [value](int, int) { return value; });
  };
  const double detectable = welch_test(about(200, 10).view(), about(201, 10).view(), 0.01).image.detectable;
  // Each of three channels finds it with probability 1/2, so that 7/8 are found of it and 15 % of its half. The bounds
  // are left with probability 1e-3 each.
  int found = 0, found_of_half = 0;
  for (std::uint32_t seed = 300; seed < 380; ++seed) {
    const Estimate a = about(2 * seed, 10);
    found += welch_test(a.view(), about(2 * seed + 1, 10 + detectable).view(), 0.01).image.differs ? 1 : 0;
    found_of_half +=
        welch_test(a.view(), about(2 * seed + 1, 10 + 0.5 * detectable).view(), 0.01).image.differs ? 1 : 0;
  }
  EXPECT_GE(found, 60);
  EXPECT_LE(found_of_half, 23);
}

// Normal errors that squares of 8 x 8 pixels have in common, with their correct standard errors.
Estimate shared_errors(std::uint32_t seed, double common) {
  Estimate e{make_pixel_buffer(96, 80, {"R", "G", "B"}), make_pixel_buffer(96, 80, {"R", "G", "B"}), 16};
  RandomStream<float> random(seed, 79u);
  const auto normal = [&] { return special::normal_quantile(double(random.next()) + 0x1p-26); };
  std::vector<double> of_square(12 * 10 * 3);
  for (double& value : of_square) value = common * normal();
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 96; ++x)
      for (int c = 0; c < 3; ++c) {
        e.mean.at(x, y, c) = float(10 + of_square[std::size_t((y / 8 * 12 + x / 8) * 3 + c)] + normal());
        e.error.at(x, y, c) = float(std::sqrt(1 + common * common));
      }
  return e;
}

TEST(Welch, errors_that_pixels_share_are_seen_in_the_blocks_where_the_images_say_so) {
  int differ = 0, differ_untold = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Estimate a = shared_errors(2 * seed, 0.25), b = shared_errors(2 * seed + 1, 0.25);
    EstimatedImage first = a.view(), second = b.view();
    differ_untold += welch_test(first, second, 0.01).blocks.differs ? 1 : 0;
    first.pixels_share_samples = second.pixels_share_samples = true;
    differ += welch_test(first, second, 0.01).blocks.differs ? 1 : 0;
  }
  EXPECT_LE(differ, 2);
  EXPECT_GE(differ_untold, 18);
}

}  // namespace
}  // namespace montelux
