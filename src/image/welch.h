// Do two estimates of an image differ by more than their own errors? Welch's t-test at several scales.
#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "image/pixel_buffer.h"

namespace montelux {

// An estimated image: the means, the standard errors of the means (same size and channel order; zero for a value that
// is known exactly), and the degrees of freedom of each standard error: the number of independent passes minus one,
// or infinite if the errors are known.
struct EstimatedImage {
  const PixelBuffer& mean;
  const PixelBuffer& standard_error;
  double degrees_of_freedom;
  // The standard error of the mean of the whole image, in red, green and blue, if the passes provide it.
  std::optional<std::array<double, 3>> error_of_mean = {};
  // The pixels of a pass share samples, so that their errors may be correlated.
  bool pixels_share_samples = false;
};

// The outcome at one scale: the most significant of all its tests, at the pixel where its region begins.
struct WelchScale {
  std::size_t tests = 0;
  double smallest_p = 1.0;
  // Of that test: the distance of the two in standard errors (signed: first minus second), and the difference that it
  // detects at this family-wise level with probability one half.
  double t = 0.0;
  double difference = 0.0;
  double detectable = 0.0;
  double detectable_median = 0.0;  // the same over all tests of the scale
  int x = 0, y = 0, channel = 0;
  int side = 0;  // of the region, in pixels; 0: the whole image
  // smallest_p is below level / (3 tests).
  bool differs = false;
};

struct WelchReport {
  WelchScale image;
  WelchScale blocks;
  WelchScale pixels;
  // One of the scales differs. If the two images have equal expectations, the probability of this is at most level.
  bool differs = false;
};

// Two-sided tests (Welch 1947) of the mean of the image, of blocks of 8x8, 16x16, 32x32, ... pixels and of single
// pixels, for each of the three colour channels. The level is divided equally between the three scales and the
// tests within each (Bonferroni). A value that is not finite counts as a difference.
//
// Errors that are estimated from passes, and skewed pixel values, require three corrections; errors that are
// known (infinite degrees of freedom) are used unchanged.
// 1. Variances are raised to what is known from elsewhere, see raised_variance().
// 2. The variance of the darker image is increased by grain x |difference|, where its grain is the sum of all variances
//    over the sum of all means: the variance of rare samples of equal size whose mean is the difference and none of
//    which was drawn. (Bernstein's inequality has this form.)
// 3. If pixels share samples, block tests are divided by the factor by which their squares exceed those of a normal
//    variable, at the median or at 90 %, whichever is larger, but at most 3; and by the factor that the image means of
//    the passes show, if that is larger.
// Pixels are otherwise assumed to be independent of each other within a pass. The image mean uses the larger of the
// variance of the sum of its pixels and its spread over the passes.
WelchReport welch_test(const EstimatedImage& a, const EstimatedImage& b, double level);

}  // namespace montelux
