// Short renders before a comparison: the predicted duration, the expected errors, and the method that renders the
// reference.
#pragma once
#include <array>

#include "lab/compare/comparison.h"

namespace montelux::lab {

// About one repeat of one method, in two independent halves: the error of one is measured against the mean of the
// other, so that the divisor of a relative error does not share its noise.
struct Pilot {
  struct Half {
    PixelBuffer mean, variance;  // R, G, B; the variance is that of the mean
  };
  std::array<Half, 2> halves;
  double samples = 0;      // per pixel, of both halves
  double all_seconds = 0;  // of both halves, by the clock of the settings
  double wall_seconds = 0;
};

// The expected elapsed seconds for one sample of the whole image, measured by one pass of each method; the
// plans are those of the state.
std::vector<double> time_methods(const std::vector<ComparedMethod>& compared_methods, const ComparisonState& state,
                                 const ComparisonSettings& settings, const ComparisonWatch& watch);

// One pilot for each method; truncated if it was stopped.
std::vector<Pilot> run_pilots(const std::vector<ComparedMethod>& compared_methods, const ComparisonState& state,
                              const std::vector<double>& sample_seconds, const ComparisonSettings& settings,
                              const ComparisonWatch& watch);

// The error by the measure that each pilot would have as a whole, in the form of squared_error_by(). `trusted` are the
// methods whose means may serve as reference for the errors.
std::vector<double> pilot_errors(const std::vector<Pilot>& pilots, const std::vector<std::size_t>& trusted,
                                 ErrorMeasure measure);

// The goal of make_reference().
struct ReferenceGoal {
  std::size_t method = 0;      // that renders it
  ByMeasure<double> variance;  // upper limit as in variance_by(), by relMSE and by MSE
  double samples = 0;          // per pixel, expected
  double seconds = 0;          // elapsed time, expected
};
// The most efficient of the permitted methods by the measure, and a reference whose variance is `share` of
// the smallest expected error of one repeat.
ReferenceGoal plan_reference(const std::vector<Pilot>& pilots, const std::vector<std::size_t>& may_serve,
                             const std::vector<double>& samples_of_repeat, ErrorMeasure measure, double share);

// Ends at the goal's variance, or at a million samples per pixel.
Reference make_reference(const std::vector<ComparedMethod>& compared_methods, const ReferenceGoal& goal,
                         const ComparisonSettings& settings, const ComparisonWatch& watch);

}  // namespace montelux::lab
