// From the sums of passes to an estimate with its error bar.
#pragma once
#include "lab/integral/integrate.h"

namespace montelux::lab {

// The mean over passes. Passes weigh by their samples; degrees of freedom are those of the t distribution.
struct PassEstimate {
  double mean = 0, standard_error = 0, degrees = 0;  // the error is that of rounding at the least
  bool spread = false;                               // the passes differ by more than rounding
  std::optional<double> coefficient;                 // of the control variate
  // Half the width of the interval that holds the truth with probability `confidence`; infinite below two passes.
  double reach(double confidence) const;
};
PassEstimate estimate_of(const IntegralState& state);

// Is every term 0? Then the mean is 0, and nothing is known of its error.
bool found_nothing(const IntegralState& state);

// The confidence that the look number `look` (from 1) of a stopping rule must have, so that all looks together keep
// `confidence`: the error rate alpha is spent as alpha / (k (k + 1)) (Lan and DeMets 1983; Bonferroni's inequality).
double confidence_of_look(double confidence, int look);

}  // namespace montelux::lab
