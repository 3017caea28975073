// Distributions of error: how far the mean of a few independent realisations may lie from the truth.
#pragma once
#include "math/special.h"

namespace montelux {

// The distributions themselves are mathematics, known here by their short names.
using special::incomplete_beta;
using special::normal_cdf;
using special::normal_quantile;
using special::student_t_cdf;
using special::student_t_quantile;

struct Interval {
  double low, high;
};

// The interval around the mean of `count` (>= 2) independent realisations that holds the true mean with probability
// `level`, where the realisations are near to normal (Student 1908).
Interval confidence_interval(double mean, double standard_error, double count, double level = 0.95);

}  // namespace montelux
