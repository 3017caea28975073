#include "image/welch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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
    EXPECT_EQ(report.blocks.tests, 3u * 4 * 3);
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
  Estimate b = estimate(16, 6, [](int x, int y) { return x == 7 && y == 20 ? 6.0 : 1.0; });
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

}  // namespace
}  // namespace montelux
