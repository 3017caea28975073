#include "math/special.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace montelux::special {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double log_sqrt_two_pi = 0.918938533204672741780;
constexpr int iteration_limit = 200000;

// The remainder of log Gamma(x) after Stirling's formula, for x >= 10 (DLMF 5.11.1).
double stirling_remainder(double x) {
  double r = 1.0 / (x * x);
  double s = 1.0 / 156.0;
  s = -691.0 / 360360.0 + r * s;
  s = 1.0 / 1188.0 + r * s;
  s = -1.0 / 1680.0 + r * s;
  s = 1.0 / 1260.0 + r * s;
  s = -1.0 / 360.0 + r * s;
  s = 1.0 / 12.0 + r * s;
  return s / x;
}

// log(1 + u) - u for u > -1, without cancellation near zero.
double log1p_minus(double u) {
  if (std::fabs(u) > 0.1) return std::log1p(u) - u;
  double power = u, sum = 0.0;
  for (int n = 2; n < 40; ++n) {
    power *= -u;
    double term = power / n;
    sum += term;
    if (std::fabs(term) <= 0.1 * epsilon * std::fabs(sum)) break;
  }
  return sum;
}

// x^a e^-x / Gamma(a). For large a the exponent is taken about its peak, where the plain form would cancel.
double gamma_kernel(double a, double x) {
  if (a < 10.0) return std::exp(a * std::log(x) - x - log_gamma(a));
  double exponent = a * log1p_minus((x - a) / a) - stirling_remainder(a);
  return std::sqrt(0.5 * a * std::numbers::inv_pi) * std::exp(exponent);
}

// P by its power series (DLMF 8.7.1), for x < a + 1.
double gamma_p_series(double a, double x) {
  double term = 1.0 / a, sum = term;
  for (int n = 1; n < iteration_limit && term > sum * 0.1 * epsilon; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * gamma_kernel(a, x);
}

// A number that replaces zero in Lentz's evaluation of a continued fraction.
double nonzero(double x) { return std::fabs(x) < 1e-290 ? 1e-290 : x; }

// Q by its continued fraction (DLMF 8.9.2), for x >= a + 1, evaluated by the modified method of Lentz.
double gamma_q_fraction(double a, double x) {
  double b = x + 1.0 - a, c = 1e290, d = 1.0 / nonzero(b), h = d;
  for (int n = 1; n < iteration_limit; ++n) {
    double numerator = -n * (n - a);
    b += 2.0;
    d = 1.0 / nonzero(numerator * d + b);
    c = nonzero(b + numerator / c);
    h *= c * d;
    if (std::fabs(c * d - 1.0) < epsilon) break;
  }
  return h * gamma_kernel(a, x);
}

// log B(a, b), by the quotient of the two large gamma functions rather than the difference of their logarithms.
double log_beta(double a, double b) {
  if (a < b) return log_beta(b, a);
  if (a < 10.0) return log_gamma(a) + log_gamma(b) - log_gamma(a + b);
  double growth = (a - 0.5) * std::log1p(b / a) + b * std::log(a + b) - b;
  return log_gamma(b) - growth - stirling_remainder(a + b) + stirling_remainder(a);
}

// The continued fraction of I_x(a, b) (DLMF 8.17.22), which converges fast for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  double c = 1.0, d = 1.0 / nonzero(1.0 - (a + b) * x / (a + 1.0)), h = d;
  for (int m = 1; m < iteration_limit; ++m) {
    double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    d = 1.0 / nonzero(1.0 + even * d);
    c = nonzero(1.0 + even / c);
    h *= c * d;
    double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    d = 1.0 / nonzero(1.0 + odd * d);
    c = nonzero(1.0 + odd / c);
    h *= c * d;
    if (std::fabs(c * d - 1.0) < epsilon) break;
  }
  return h;
}

// I_x(a, b) where the caller knows y = 1 - x without rounding.
double beta_of(double a, double b, double x, double y) {
  if (x <= 0.0) return 0.0;
  if (y <= 0.0) return 1.0;
  double log_x = x < 0.5 ? std::log(x) : std::log1p(-y);
  double log_y = y < 0.5 ? std::log(y) : std::log1p(-x);
  double kernel = std::exp(a * log_x + b * log_y - log_beta(a, b));
  if (x < (a + 1.0) / (a + b + 2.0)) return kernel * beta_fraction(a, b, x) / a;
  return 1.0 - kernel * beta_fraction(b, a, y) / b;
}

double student_t_density(double t, double dof) {
  return std::exp(-0.5 * (dof + 1.0) * std::log1p(t * t / dof) - log_beta(0.5 * dof, 0.5)) / std::sqrt(dof);
}

// The t > 0 with P(T > t) = p for p < 1/2: Newton's method on log p as a function of log t, kept within a bracket.
double student_t_upper(double p, double dof) {
  double low = 0.0, high = 1.0;
  while (student_t_tail(high, dof) > p && high < 1e300) {
    low = high;
    high *= 4.0;
  }
  double t = low > 0.0 ? std::sqrt(low * high) : 0.5 * high;
  for (int i = 0; i < 200; ++i) {
    double tail = student_t_tail(t, dof);
    (tail > p ? low : high) = t;
    double next = t * std::exp((std::log(tail) - std::log(p)) * tail / (t * student_t_density(t, dof)));
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::fabs(next - t) <= 2.0 * epsilon * t) return next;
    t = next;
  }
  return t;
}

}  // namespace

double log_gamma(double x) {
  if (!(x > 0.0)) return not_a_number;
  if (x == infinity) return infinity;
  double product = 1.0;
  for (; x < 10.0; x += 1.0) product *= x;
  return (x - 0.5) * std::log(x) - x + log_sqrt_two_pi + stirling_remainder(x) - std::log(product);
}

double gamma_p(double a, double x) {
  if (!(a > 0.0) || !(x >= 0.0)) return not_a_number;
  if (x == 0.0) return 0.0;
  if (x == infinity) return 1.0;
  return x < a + 1.0 ? gamma_p_series(a, x) : 1.0 - gamma_q_fraction(a, x);
}

double gamma_q(double a, double x) {
  if (!(a > 0.0) || !(x >= 0.0)) return not_a_number;
  if (x == 0.0) return 1.0;
  if (x == infinity) return 0.0;
  return x < a + 1.0 ? 1.0 - gamma_p_series(a, x) : gamma_q_fraction(a, x);
}

double incomplete_beta(double a, double b, double x) {
  if (!(a > 0.0) || !(b > 0.0) || !(x >= 0.0 && x <= 1.0)) return not_a_number;
  return beta_of(a, b, x, 1.0 - x);
}

double normal_cdf(double z) { return 0.5 * std::erfc(-z * (1.0 / std::numbers::sqrt2)); }
double normal_tail(double z) { return normal_cdf(-z); }

double normal_quantile(double p) {
  if (!(p >= 0.0 && p <= 1.0)) return not_a_number;
  if (p == 0.0) return -infinity;
  if (p == 1.0) return infinity;
  // A start within 4.5e-4 in either tail (Abramowitz and Stegun 26.2.23), then steps of Halley's method.
  double tail = p < 0.5 ? p : 1.0 - p;
  double t = std::sqrt(-2.0 * std::log(tail));
  double z = (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
  for (int i = 0; i < 3; ++i) {
    double density = std::exp(-0.5 * z * z - log_sqrt_two_pi);
    if (!(density > 0.0)) break;
    double e = (normal_cdf(z) - tail) / density;
    z -= e / (1.0 + 0.5 * z * e);
  }
  return p < 0.5 ? z : -z;
}

double student_t_tail(double t, double dof) {
  if (!(dof > 0.0) || std::isnan(t)) return not_a_number;
  if (dof == infinity) return normal_tail(t);
  if (std::isinf(t)) return t > 0.0 ? 0.0 : 1.0;
  // Both parts of 1 = dof / (dof + t^2) + t^2 / (dof + t^2) are formed without subtraction.
  double ratio = t / std::sqrt(dof) * (t / std::sqrt(dof));
  if (ratio == infinity) return t > 0.0 ? 0.0 : 1.0;
  double half = 0.5 * beta_of(0.5 * dof, 0.5, 1.0 / (1.0 + ratio), ratio / (1.0 + ratio));
  return t > 0.0 ? half : 1.0 - half;
}
double student_t_cdf(double t, double dof) { return student_t_tail(-t, dof); }

double student_t_quantile(double p, double dof) {
  if (!(p >= 0.0 && p <= 1.0) || !(dof > 0.0)) return not_a_number;
  if (dof == infinity || p == 0.0 || p == 1.0) return normal_quantile(p);
  if (p == 0.5) return 0.0;
  return p < 0.5 ? -student_t_upper(p, dof) : student_t_upper(1.0 - p, dof);
}

double chi_square_tail(double x, double dof) { return gamma_q(0.5 * dof, 0.5 * x); }

}  // namespace montelux::special
