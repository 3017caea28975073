// A requested error of a picture, and whether a film has it.
#pragma once
#include <limits>
#include <optional>

#include "film/film_planes.h"
#include "film/picture_error.h"
#include "mc/confidence.h"

namespace montelux {

struct ImageEstimate;

// Which error of a picture against its expectation. All of them are relative.
enum class TargetMeasure {
  relative,  // the root of the mean relative squared error, as ErrorEstimate has it
  pixels,    // the error that a share of the pixels is within; that of a pixel is the root of the mean over channels of
             // difference^2 / (expectation^2 + 0.01)
  mean,      // that of the mean over all pixels and channels
  denoised,  // as `relative`, of the image after its noise is removed, bias included
};

struct ErrorTarget {
  TargetMeasure measure = TargetMeasure::relative;
  double error = 0.01;
  double share = 0.95;                     // of the pixels; for TargetMeasure::pixels
  double confidence = default_confidence;  // the probability that the true error is within the requested one
  bool operator==(const ErrorTarget&) const = default;
};

// What the removal of noise leaves of a squared error falls like this power of the number of samples, about: like 0.64
// to 0.9 from 16 to 64 samples in the ten scenes of docs/denoising.md, and less with fewer samples.
inline constexpr double filtered_power = 0.7;

// What the removal of noise leaves of a film's error.
struct FilteredError {
  double relative_mse = 0;  // the mean relative squared error, bias included
  double unfiltered = 0;    // of it, noise of pixels that is left as it is
  double deviation = 0;     // its standard deviation, by the spread of what pixels add to it
};

// What is known of a film's error against a target.
struct TargetState {
  bool is_known = false;                                   // false: it takes two passes of every pixel, and light
  double error = std::numeric_limits<double>::infinity();  // the estimate
  double bound = std::numeric_limits<double>::infinity();  // with the target's confidence the true error is below
  // The total number of samples that the target requires, over the number that the film has: the factor if no bright
  // samples are rarer than those found, and an interval that contains it with a probability of about 95 %, whose upper
  // end takes them into account.
  double work = std::numeric_limits<double>::infinity(), work_low = work, work_high = work;

  bool reaches(const ErrorTarget& target) const { return is_known && bound <= target.error; }
};

// `spent`: the share of the probability of a wrong statement that this look at the film may use; 1 if it is the only
// one. `image` and `error` are those of the film whose planes these are, and `filtered` is what the removal of noise
// leaves of it: the state is unknown without it if that is requested.
//
// The true error of a picture is random around its expectation, of which the film gives an estimate. The bound includes
// both, and the uncertainty of the divisors. Of these only the estimate depends on what earlier looks saw.
// - relative: the logarithm of the sum over pixels, with the number of effective pixels (Kish 1965) and the tail of
//   their errors;
// - pixels: the squared error of a pixel over its estimate has an F distribution, with the estimates of the calibrated
//   intervals of pixels (pixel_intervals()), but an error at most twice that of the pixels' own variances; the
//   number of pixels beyond the error is a Poisson number;
// - mean: Student's t over the passes. Here looks spend nothing: they see only the spread of the passes, which is
//   independent of their mean where they are normal (Chow and Robbins 1965), as long as they are few and the first one
//   is at eight passes or more.
// - denoised: what the filter leaves, by the spread of what pixels add to it, by the number of effective pixels that
//   have the noise that it leaves as it is, and by the tail of the errors before the filter.
// Light that paths meet by chance adds to each of them what may be missing of it (missing_samples()).
TargetState judge(const ErrorTarget& target, const FilmPlanes& planes, const ErrorEstimate& error,
                  const ImageEstimate& image, double spent, const std::optional<FilteredError>& filtered = {});

}  // namespace montelux
