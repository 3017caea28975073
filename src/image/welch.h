// Do two estimates of an image differ by more than their own errors? Welch's t-test at three scales.
#pragma once
#include <cstddef>

#include "image/pixel_buffer.h"

namespace montelux {

// An estimated image: the means, the standard errors of the means (same size and channel order; zero for a value that
// is known exactly), and the degrees of freedom of each standard error, which is one less than the number of
// independent passes. Infinite for errors that are known.
struct EstimatedImage {
  const PixelBuffer& mean;
  const PixelBuffer& standard_error;
  double degrees_of_freedom;
};

// The outcome at one scale: the most significant of all its tests, at the pixel where its block begins.
struct WelchScale {
  std::size_t tests = 0;
  double smallest_p = 1.0;
  // Of that test: how many standard errors the two are apart (signed: first minus second), and the smallest difference
  // that the test would have found at this family-wise level.
  double t = 0.0;
  double difference = 0.0;
  double detectable = 0.0;
  int x = 0, y = 0, channel = 0;
  // smallest_p is below level / (3 tests).
  bool differs = false;
};

struct WelchReport {
  WelchScale image;
  WelchScale blocks;
  WelchScale pixels;
  // One of the scales differs. Where the two images have equal expectation this happens with probability at most level.
  bool differs = false;
};

// Two-sided tests (Welch 1947) of the mean of the image, of blocks of 8x8 pixels and of single pixels, for each of the
// three colour channels. Pixels are taken as independent of each other within a pass. The level is shared out equally
// over the three scales and over the tests within each (Bonferroni). A value that is not finite counts as a difference.
WelchReport welch_test(const EstimatedImage& a, const EstimatedImage& b, double level);

}  // namespace montelux
