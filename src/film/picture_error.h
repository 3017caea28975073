// The error of an image against its expectation, estimated from the spread of its pixels over passes.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "film/film_planes.h"
#include "mc/confidence.h"

namespace montelux {

// Added to the squared expectation by which a squared error is divided (Rousselle, Knaus and Zwicker 2011).
inline constexpr double relative_epsilon = 0.01;
// The standard deviation of the logarithm of a relative mean squared error because its divisors are estimates, with so
// many samples of a pixel: where many pixels have the error, images of 109 scenes with 8, 32 and 128 samples state in
// their mean 0.8 to 1.25, 0.9 to 1.1 and 0.95 to 1.05 of the true one.
inline double divisor_deviation(double samples) { return std::hypot(0.05, 0.8 / samples); }

// The number of samples that may be missing of light that is met by chance, with this probability, while none shows it:
// of a Poisson number that is 0 (the rule of three; Hanley and Lippman-Hand 1983).
inline double missing_samples(double confidence) { return -std::log1p(-confidence); }

// The interval of a mean, whose upper end leaves room for such light; `chance_light`: of one sample, in the mean.
Interval interval_with_missing(const Interval& interval, double chance_light, double confidence);

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
  double log_deviation = 0;
  // What one sample adds to the mean of the image if it is as bright as a sample by chance can be, by channel, and the
  // mean of the channels over that of the image.
  std::array<double, rgb_size> chance_light{};
  double chance_share = 0;
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
  // The light that may be missing because it is met by chance, over the mean of the image.
  double missing_share(double confidence) const { return missing_samples(confidence) * chance_share; }
  // Whether this is a tenth or more.
  bool may_miss_light() const { return pixels > 0 && missing_share(default_confidence) >= 0.1; }
};

// Relative errors are products of variances and Reciprocals, with the correction of PartialCovers.
ErrorEstimate estimate_error(const FilmPlanes& planes);

}  // namespace montelux
