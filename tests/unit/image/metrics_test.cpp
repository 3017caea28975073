#include "image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "image/flip.h"

namespace montelux {
namespace {

PixelBuffer constant(int width, int height, float r, float g, float b) {
  PixelBuffer image = make_pixel_buffer(width, height, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.values.size(); i += 3) {
    image.values[i] = r;
    image.values[i + 1] = g;
    image.values[i + 2] = b;
  }
  return image;
}

TEST(Metrics, measures_of_constant_images_are_their_closed_forms) {
  ErrorMeasures m = measure_error(constant(4, 3, 0.5f, 0.5f, 0.5f), constant(4, 3, 0.25f, 0.5f, 0.75f));
  EXPECT_NEAR(m.mse, 2.0 / 3.0 * 0.0625, 1e-12);
  EXPECT_NEAR(m.relative_mse, (0.0625 / 0.0725 + 0.0625 / 0.5725) / 3.0, 1e-12);
  EXPECT_NEAR(m.psnr, -10.0 * std::log10(m.mse), 1e-12);
  EXPECT_NEAR(m.mean_difference, 0.0, 1e-12);
  EXPECT_EQ(m.non_finite, 0u);
}

TEST(Metrics, non_finite_pixels_are_counted_and_left_out) {
  PixelBuffer a = constant(2, 1, 1.0f, 1.0f, 1.0f), b = constant(2, 1, 0.0f, 0.0f, 0.0f);
  a.values[0] = std::numeric_limits<float>::quiet_NaN();
  ErrorMeasures m = measure_error(a, b);
  EXPECT_EQ(m.non_finite, 1u);
  EXPECT_DOUBLE_EQ(m.mse, 1.0);
}

TEST(Metrics, mean_of_the_error_map_is_the_measure) {
  PixelBuffer a = constant(3, 2, 0.1f, 0.2f, 0.3f), b = constant(3, 2, 0.3f, 0.1f, 0.9f);
  PixelBuffer map = error_map(a, b, ErrorKind::relative_squared);
  EXPECT_NEAR(map.at(2, 1, 0), measure_error(a, b).relative_mse, 1e-6);
}

TEST(Flip, equal_images_do_not_differ) {
  PixelBuffer a = constant(9, 7, 0.3f, 0.6f, 0.1f);
  EXPECT_EQ(ldr_flip(a, a).mean, 0.0);
  EXPECT_EQ(hdr_flip(a, a).mean, 0.0);
}

TEST(Flip, largest_color_difference_is_that_of_green_and_blue_and_is_one) {
  FlipResult r = ldr_flip(constant(5, 5, 0.0f, 1.0f, 0.0f), constant(5, 5, 0.0f, 0.0f, 1.0f));
  EXPECT_NEAR(r.mean, 1.0, 1e-3);
}

TEST(Flip, black_against_white_follows_from_the_knee_of_the_difference) {
  // HyAB of black and white is 100; with 0.7 as exponent it is below the maximum of green and blue.
  // Constants by hand: lightness of green 87.73, of blue 32.30; (a, b) by CIELAB, times 0.01 L (Hunt).
  double green_a = -86.18 * 0.8773, green_b = 83.18 * 0.8773, blue_a = 79.19 * 0.3230, blue_b = -107.86 * 0.3230;
  double largest = std::pow(87.73 - 32.30 + std::hypot(green_a - blue_a, green_b - blue_b), 0.7);
  double d = std::pow(100.0, 0.7), knee = 0.4 * largest;
  double expected = 0.95 + 0.05 * (d - knee) / (largest - knee);
  EXPECT_NEAR(ldr_flip(constant(5, 5, 0, 0, 0), constant(5, 5, 1, 1, 1)).mean, expected, 2e-3);
}

TEST(Flip, a_sharp_edge_counts_more_than_its_color_difference_alone) {
  PixelBuffer flat = constant(32, 32, 0.5f, 0.5f, 0.5f), edge = flat, all = constant(32, 32, 0.55f, 0.55f, 0.55f);
  for (int y = 0; y < 32; ++y)
    for (int x = 16; x < 32; ++x)
      for (int c = 0; c < 3; ++c) edge.at(x, y, c) = 0.55f;
  FlipResult with_edge = ldr_flip(edge, flat), without = ldr_flip(all, flat);
  EXPECT_GT(with_edge.map.at(16, 16, 0), without.map.at(16, 16, 0));
  EXPECT_LT(with_edge.map.at(0, 16, 0), 1e-3f);
}

TEST(Flip, hdr_flip_sees_what_every_single_exposure_hides) {
  // A difference in the highlights alone, far above one: cut off at exposure zero, plain to HDR-FLIP.
  PixelBuffer reference = constant(16, 16, 0.2f, 0.2f, 0.2f), test = reference;
  for (int c = 0; c < 3; ++c) {
    reference.at(8, 8, c) = 100.0f;
    test.at(8, 8, c) = 30.0f;
  }
  EXPECT_EQ(ldr_flip(test, reference).mean, 0.0);
  EXPECT_GT(hdr_flip(test, reference).map.at(8, 8, 0), 0.2f);
}

}  // namespace
}  // namespace montelux
