// Short renders before a comparison: how long it is going to take, which error is to be expected, and which method is
// to make the reference.
#pragma once
#include <array>

#include "lab/compare/comparison.h"

namespace montelux::lab {

// About one repeat of one method, in two independent halves: the error of one is held against the mean of the other, so
// that the divisor of a relative error does not share its noise.
struct Pilot {
  struct Half {
    PixelBuffer mean, variance;  // R, G, B; the variance is that of the mean
  };
  std::array<Half, 2> halves;
  double samples = 0;      // a pixel, of both halves
  double all_seconds = 0;  // of both halves, by the clock of the settings
  double wall_seconds = 0;
};

// Seconds of the machine's clock that a sample of the whole picture is going to take, by one pass of each method; the
// plans are those of the state.
std::vector<double> time_methods(const std::vector<ComparedMethod>& compared_methods, const ComparisonState& state,
                                 const ComparisonSettings& settings, const ComparisonWatch& watch);

// One of each method, cut short where it was stopped.
std::vector<Pilot> run_pilots(const std::vector<ComparedMethod>& compared_methods, const ComparisonState& state,
                              const std::vector<double>& sample_seconds, const ComparisonSettings& settings,
                              const ComparisonWatch& watch);

// The error by the measure that each pilot would have as a whole, in the form of squared_error_by(). `trusted` are the
// methods whose means the errors may be held against.
std::vector<double> pilot_errors(const std::vector<Pilot>& pilots, const std::vector<std::size_t>& trusted,
                                 ErrorMeasure measure);

// What make_reference() goes by.
struct ReferenceGoal {
  std::size_t method = 0;      // that makes it
  ByMeasure<double> variance;  // at most, as variance_by() has it, by relMSE and by MSE
  double samples = 0;          // a pixel, that this is expected to take
  double seconds = 0;          // the same, by the machine's clock
};
// The most efficient by the measure of those that may serve, and so good a reference that its variance is `share` of
// the smallest error to be expected in one repeat.
ReferenceGoal plan_reference(const std::vector<Pilot>& pilots, const std::vector<std::size_t>& may_serve,
                             const std::vector<double>& samples_of_repeat, ErrorMeasure measure, double share);

// Ends at the goal's variance, or at a million samples a pixel.
Reference make_reference(const std::vector<ComparedMethod>& compared_methods, const ReferenceGoal& goal,
                         const ComparisonSettings& settings, const ComparisonWatch& watch);

}  // namespace montelux::lab
