// Distributions of error: how far the mean of a few independent realisations may lie from the truth.
#pragma once

namespace montelux {

// Probability that a standard normal variable is at most z.
double normal_cdf(double z);
// The z with normal_cdf(z) = p, for p in (0, 1).
double normal_quantile(double p);

// The regularised incomplete beta function I_x(a, b) for a, b > 0 and x in [0, 1].
double incomplete_beta(double a, double b, double x);
// Probability that Student's t with `degrees` (> 0) of freedom is at most t.
double student_t_cdf(double t, double degrees);
// The t with student_t_cdf(t, degrees) = p, for p in (0, 1).
double student_t_quantile(double p, double degrees);

struct Interval {
  double low, high;
};

// The interval around the mean of `count` (>= 2) independent realisations that holds the true mean with probability
// `level`, where the realisations are near to normal (Student 1908).
Interval confidence_interval(double mean, double standard_error, double count, double level = 0.95);

}  // namespace montelux
