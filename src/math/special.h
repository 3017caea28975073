// Special functions of statistics, in double precision: p-values, quantiles and confidence levels rest on them.
// Arguments outside the stated domain give a quiet NaN. Relative errors are about 1e-13 for moderate parameters and
// stay below 1e-8 for parameters up to 1e7.
#pragma once

namespace montelux::special {

// log Gamma(x) for x > 0, by Stirling's series after shifting x above 10 (DLMF 5.11.1).
double log_gamma(double x);
// The regularised incomplete gamma functions P(a, x) and Q = 1 - P for a > 0, x >= 0 (DLMF 8.2.4).
double gamma_p(double a, double x);
double gamma_q(double a, double x);
// The regularised incomplete beta function I_x(a, b) for a, b > 0 and x in [0, 1] (DLMF 8.17.2).
double incomplete_beta(double a, double b, double x);

// The standard normal distribution: P(Z <= z), P(Z > z), and the z with P(Z <= z) = p (infinite at p = 0 and 1).
double normal_cdf(double z);
double normal_tail(double z);
double normal_quantile(double p);

// Student's t with dof > 0 degrees of freedom, which need not be whole; infinite dof is the normal distribution.
double student_t_cdf(double t, double dof);
double student_t_tail(double t, double dof);
double student_t_quantile(double p, double dof);

// P(X > x) for a chi-square variable X with dof > 0 degrees of freedom.
double chi_square_tail(double x, double dof);

}  // namespace montelux::special
