#include "mc/confidence.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace montelux {

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_quantile(double p) {
  // A start by the tail's leading term, then Newton on the CDF; in the tail on its logarithm, where it is concave.
  if (p > 0.5) return -normal_quantile(1 - p);
  double z = p > 0.02 ? (p - 0.5) * std::sqrt(2 * std::numbers::pi) : -std::sqrt(-2 * std::log(p));
  for (int i = 0; i < 100; ++i) {
    const double cdf = normal_cdf(z);
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
    const double step = (std::log(cdf) - std::log(p)) * cdf / density;
    z -= step;
    if (std::abs(step) <= 1e-14 * (1 + std::abs(z))) break;
  }
  return z;
}

namespace {

// The continued fraction of the incomplete beta function (NIST DLMF 8.17.22) by Lentz's method.
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = std::numeric_limits<double>::min() * 1e4;
  const auto bounded = [](double v) { return std::abs(v) < tiny ? tiny : v; };
  double c = 1, d = 1 / bounded(1 - (a + b) * x / (a + 1)), h = d;
  for (int m = 1; m <= 10000; ++m) {
    for (int odd = 0; odd < 2; ++odd) {
      const double numerator = odd == 0 ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
                                        : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
      d = 1 / bounded(1 + numerator * d);
      c = bounded(1 + numerator / c);
      h *= d * c;
    }
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return h;
}

}  // namespace

double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  // The fraction converges fast on this side of the mean; on the other use the symmetry.
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
  return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

double student_t_cdf(double t, double degrees) {
  const double tail = 0.5 * incomplete_beta(0.5 * degrees, 0.5, degrees / (degrees + t * t));
  return t > 0 ? 1 - tail : tail;
}

double student_t_quantile(double p, double degrees) {
  if (p == 0.5) return 0;
  if (p > 0.5) return -student_t_quantile(1 - p, degrees);
  // Bracket the root below zero, then halve: robust for every number of degrees.
  double low = -1, high = 0;
  while (student_t_cdf(low, degrees) > p) high = low, low *= 2;
  for (int i = 0; i < 200 && high - low > 1e-14 * (1 - low); ++i) {
    const double middle = 0.5 * (low + high);
    (student_t_cdf(middle, degrees) > p ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

Interval confidence_interval(double mean, double standard_error, double count, double level) {
  const double reach = student_t_quantile(0.5 + 0.5 * level, count - 1) * standard_error;
  return {mean - reach, mean + reach};
}

}  // namespace montelux
