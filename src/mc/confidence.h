// Distributions of error: how far the mean of a few independent realisations may be from the expectation.
#pragma once
#include "math/special.h"

namespace montelux {

// The distributions themselves are in math; here they have short names.
using special::incomplete_beta;
using special::normal_cdf;
using special::normal_quantile;
using special::student_t_cdf;
using special::student_t_quantile;

struct Interval {
  double low, high;
};

// Of intervals and promises, where nothing else is requested.
inline constexpr double default_confidence = 0.95;

// The interval around the mean of `count` (>= 2) independent realisations that contains the true mean with probability
// `level`, if the realisations are nearly normal (Student 1908).
Interval confidence_interval(double mean, double standard_error, double count, double level = default_confidence);

}  // namespace montelux
