// The error of an image against its expectation, estimated from the spread of its pixels over passes.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "film/film_planes.h"

namespace montelux {

// Added to the squared expectation by which a squared error is divided (Rousselle, Knaus and Zwicker 2011).
inline constexpr double relative_epsilon = 0.01;
// The standard deviation of the logarithm of a relative mean squared error because its divisors are estimates: images
// of many scenes state 0.8 to 1.25 of the true error in their mean, which is taken as an interval of 95 %.
inline constexpr double divisor_deviation = 0.223 / 1.96;

// Estimated mean squared errors: means over channels and over the pixels that have two passes.
struct ErrorEstimate {
  double mse = 0;  // variance of the mean
  // Variance of the mean over (expectation^2 + relative_epsilon).
  double relative_mse = 0;
  double relative_low = 0, relative_high = 0;  // its interval: for about 95 % of such images it is between these
  // Of the pixels' relative squared errors: P(error > x) falls like x^-index (Hill 1975); infinite if there is no
  // tail. Below 1 they have no finite mean.
  double tail_index = std::numeric_limits<double>::infinity();
  // Number of pixels of equal and normal error whose sum would be as uncertain (Kish 1965): relative_mse of one image
  // differs from its expectation by the relative variance 2 / effective_pixels.
  double effective_pixels = 0;
  // The standard deviation of the logarithm of relative_mse apart from chance: because divisors are estimates, and
  // because bright samples may be rarer than the image shows, by the tail index.
  double log_deviation = divisor_deviation;
  std::size_t pixels = 0;  // pixels that have two passes
  std::size_t all = 0;     // pixels that could have two: sampled, with a finite sample

  // The standard deviation of the logarithm of a sum of squared errors by chance, as that of a log-normal variable;
  // `times`: of the mean of the sums of so many independent images.
  double chance_deviation(double times = 1) const { return std::sqrt(std::log1p(2 / (effective_pixels * times))); }
  // Whether it is the error of the whole image.
  bool whole() const { return pixels > 0 && pixels == all; }
  // Whether few bright samples determine the relative error, which may then be far from the true one.
  bool is_unsure() const {
    constexpr double few = 64;  // known to a factor of 1.4 at best
    return pixels > 0 && (tail_index < 1 || effective_pixels < std::min(few, double(pixels) / 8));
  }
};

// Relative errors are products of variances and Reciprocals, with the correction of PartialCovers.
ErrorEstimate estimate_error(const FilmPlanes& planes);

}  // namespace montelux
