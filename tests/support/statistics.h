// Tests of hypotheses and quadrature for the statistical tests. All return p-values; the caller holds them against one
// level for its family: p < sidak_level(1e-3, number of tests) is a rejection.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "math/vec.h"
#include "mc/confidence.h"
#include "mc/moments.h"
#include "mc/random.h"

namespace montelux::test {

// The overall level of a suite, and the level of each of `tests` independent tests that keeps the family at it.
inline constexpr double family_level = 1e-3;
inline double sidak_level(double family, double tests) { return -std::expm1(std::log1p(-family) / tests); }

// ---- distributions --------------------------------------------------------------------------------------------------

// The regularised upper incomplete gamma function Q(a, x), a > 0 (series and continued fraction, NIST
// DLMF 8.7.1, 8.9.2).
inline double upper_incomplete_gamma(double a, double x) {
  if (x <= 0) return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 100000 && term > 1e-17 * sum; ++n) sum += term *= x / (a + n);
    return 1 - front * sum;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int n = 1; n < 100000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return front * h;
}

inline double chi_square_p_value(double chi_square, double degrees) {
  return upper_incomplete_gamma(0.5 * degrees, 0.5 * chi_square);
}

// ---- tests ----------------------------------------------------------------------------------------------------------

struct TestResult {
  double statistic = 0, degrees = 0, p_value = 1;
  std::string note;
};

// Pearson's test of counts against expected counts. Cells that expect fewer than `least` are pooled, smallest first; a
// count where nothing is expected (below 1e-9 of the total) rejects outright. With fixed_total one degree is spent.
inline TestResult chi_square_test(const std::vector<double>& observed, const std::vector<double>& expected,
                                  bool fixed_total = true, double smallest = 5) {
  std::vector<std::size_t> order(expected.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
  double total = 0;
  for (double e : expected) total += e;
  TestResult r;
  double pooled_observed = 0, pooled_expected = 0, cells = 0;
  const auto add = [&](double o, double e) { r.statistic += (o - e) * (o - e) / e, cells += 1; };
  for (std::size_t i : order) {
    if (expected[i] <= 1e-9 * total && observed[i] > 0) {
      std::ostringstream note;
      note << observed[i] << " counts in cell " << i << " where " << expected[i] << " are expected";
      return {INFINITY, 1, 0, note.str()};
    }
    if (expected[i] < smallest || (pooled_expected > 0 && pooled_expected < smallest)) {
      pooled_observed += observed[i], pooled_expected += expected[i];
    } else {
      add(observed[i], expected[i]);
    }
  }
  if (pooled_expected > 0) add(pooled_observed, pooled_expected);
  r.degrees = std::max(1.0, cells - (fixed_total ? 1 : 0));
  r.p_value = chi_square_p_value(r.statistic, r.degrees);
  return r;
}

// Two-sided: is the mean `truth`, where the standard error is known (or the number of samples is large)?
inline TestResult z_test(double mean, double standard_error, double truth) {
  if (standard_error == 0) return {0, 0, mean == truth ? 1.0 : 0.0, "no spread"};
  const double z = (mean - truth) / standard_error;
  return {z, 0, 2 * normal_cdf(-std::abs(z)), {}};
}

struct SampleSummary {
  double mean = 0, variance = 0, count = 0;
  double standard_error() const { return std::sqrt(variance / count); }
};

inline SampleSummary summarize(const std::vector<double>& x) {
  SampleSummary s;
  s.count = double(x.size());
  for (double v : x) s.mean += v / s.count;
  for (double v : x) s.variance += (v - s.mean) * (v - s.mean) / (s.count - 1);
  return s;
}

// Two-sided Student test of the mean of a few near-normal values against `truth`.
inline TestResult t_test(const SampleSummary& s, double truth) {
  if (s.variance == 0) return {0, s.count - 1, s.mean == truth ? 1.0 : 0.0, "no spread"};
  const double t = (s.mean - truth) / s.standard_error();
  return {t, s.count - 1, 2 * student_t_cdf(-std::abs(t), s.count - 1), {}};
}
inline TestResult t_test(const std::vector<double>& x, double truth) { return t_test(summarize(x), truth); }
inline TestResult t_test(const Estimate& e, double truth) {
  const double n = double(e.count);
  return t_test(SampleSummary{e.mean, n * e.standard_error * e.standard_error, n}, truth);
}

// Two-sided: do two sets with unequal variances have one mean (Welch 1947)?
inline TestResult welch_test(const SampleSummary& a, const SampleSummary& b) {
  const double va = a.variance / a.count, vb = b.variance / b.count;
  if (va + vb == 0) return {0, 0, a.mean == b.mean ? 1.0 : 0.0, "no spread"};
  const double t = (a.mean - b.mean) / std::sqrt(va + vb);
  const double degrees = (va + vb) * (va + vb) / (va * va / (a.count - 1) + vb * vb / (b.count - 1));
  return {t, degrees, 2 * student_t_cdf(-std::abs(t), degrees), {}};
}

// Two-sided normal approximation: is the probability of a success `truth`?
inline TestResult proportion_test(double successes, double trials, double truth) {
  return z_test(successes, std::sqrt(trials * truth * (1 - truth)), trials * truth);
}

// One-sided: the p-value of "the truth is `bound` or more". Small values prove that it is less; 1 minus this is the
// p-value of "the truth is `bound` or less".
inline double at_least_p_value(double value, double standard_error, double bound) {
  if (standard_error == 0) return value < bound ? 0 : 1;
  return normal_cdf((value - bound) / standard_error);
}
inline double at_most_p_value(double value, double standard_error, double bound) {
  return at_least_p_value(-value, standard_error, -bound);
}

// One-sided test of two sample variances of normal values (Fisher's F): the p-value of "the first is not larger in
// truth".
inline double f_test_p_value(double a, double count_a, double b, double count_b) {
  const double da = count_a - 1, db = count_b - 1;
  return incomplete_beta(0.5 * db, 0.5 * da, db * b / (db * b + da * a));
}

// The variance of a random variable as the mean of the variances of batches, and the spread of those among the batches:
// whatever the variable's kurtosis, a t-test of this summary is a test of the variance. `realise(i)` is its i-th
// independent realisation.
template <class Realise>
SampleSummary variance_summary(Realise realise, std::uint32_t realisations, std::uint32_t batches = 50) {
  std::vector<double> variances;
  for (std::uint32_t b = 0; b < batches; ++b) {
    Moments m;
    for (std::uint32_t i = b; i < realisations; i += batches) m.add(double(realise(i)));
    variances.push_back(m.variance());
  }
  return summarize(variances);
}

// The exponent of N in a quantity that was measured at N and at `factor` N, with its standard error (delta method).
struct Exponent {
  double value, standard_error;
};
inline Exponent measured_exponent(const SampleSummary& first, const SampleSummary& second, double factor) {
  const double relative = std::hypot(first.standard_error() / first.mean, second.standard_error() / second.mean);
  return {std::log(second.mean / first.mean) / std::log(factor), relative / std::log(factor)};
}

// ---- quadrature -----------------------------------------------------------------------------------------------------

struct QuadratureRule {
  std::vector<double> x, w;  // nodes in (0, 1) and weights of sum 1
};

// The rule of n nodes on (0, 1), exact for polynomials of degree 2n - 1: Newton on the Legendre polynomial.
inline QuadratureRule gauss_legendre(int n) {
  QuadratureRule rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), derivative = 1;
    for (int k = 0; k < 100; ++k) {
      double p = 1, previous = 0;
      for (int j = 0; j < n; ++j) {
        const double before = previous;
        previous = p;
        p = ((2 * j + 1) * x * previous - j * before) / (j + 1);
      }
      derivative = n * (x * p - previous) / (x * x - 1);
      const double step = p / derivative;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    rule.x.push_back(0.5 - 0.5 * x);
    rule.w.push_back(1 / ((1 - x * x) * derivative * derivative));
  }
  return rule;
}

// The integral of f over [a, b] by `panels` panels of 8 nodes.
template <class Function>
double integrate(Function f, double a, double b, int panels = 16) {
  static const QuadratureRule rule = gauss_legendre(8);
  const double h = (b - a) / panels;
  double sum = 0;
  for (int p = 0; p < panels; ++p)
    for (std::size_t i = 0; i < rule.x.size(); ++i) sum += h * rule.w[i] * f(a + h * (p + rule.x[i]));
  return sum;
}

// The integral of f(x, y) over [ax, bx] x [ay, by].
template <class Function>
double integrate2(Function f, double ax, double bx, double ay, double by, int panels = 16) {
  return integrate([&](double x) { return integrate([&](double y) { return f(x, y); }, ay, by, panels); }, ax, bx,
                   panels);
}

// The integral over solid angle of f(Vec3f w) on the part of the sphere with cos in [low, high] about the frame's
// normal; panels in cos and in the azimuth. Put the peak of f on the normal, where the nodes may be made dense by more
// panels.
template <class Function>
double integrate_sphere(Function f, const LocalFrame<float>& frame = LocalFrame<float>::from_normal({0, 0, 1}),
                        int panels = 32, double low = -1, double high = 1) {
  return integrate2(
      [&](double cos, double azimuth) {
        const double sin = std::sqrt(std::max(0.0, 1 - cos * cos));
        return double(f(frame.to_world({float(sin * std::cos(azimuth)), float(sin * std::sin(azimuth)), float(cos)})));
      },
      low, high, 0, 2 * std::numbers::pi, panels);
}

// ---- samples against densities --------------------------------------------------------------------------------------

// A grid over [0, 1)^2 that the domain is charted on with a constant Jacobian `measure` (total measure of the domain).
struct Grid {
  int rows, columns;
  int cells() const { return rows * columns; }
};
inline constexpr Grid coarse_grid{10, 20}, fine_grid{40, 80};

// Chi-square of `count` samples against a density, both on [0, 1)^2. `sample(stream)` returns optional-like: an object
// with .x and .y in [0, 1), or a point outside of it for "none" (counted in a cell of its own, whose expectation is
// what the density lacks to 1). `density(x, y)` is per unit area of the square; `panels` per cell of 8x8 Gauss nodes.
template <class Sample, class DensityFunction>
TestResult chi_square_square(Sample sample, DensityFunction density, Grid grid, double count, std::uint32_t seed,
                             int panels = 1) {
  const auto cells = std::size_t(grid.cells());
  std::vector<double> observed(cells + 1), expected(cells + 1);
  RandomStream<float> stream(seed, 0x51ab3c07u);
  for (double i = 0; i < count; i += 1) {
    const auto p = sample(stream);
    const bool inside = p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1;
    const std::size_t cell = inside ? std::size_t(double(p.x) * grid.rows) * std::size_t(grid.columns) +
                                          std::size_t(double(p.y) * grid.columns)
                                    : cells;
    observed[std::min(cell, cells)] += 1;
  }
  double total = 0;
  for (int r = 0; r < grid.rows; ++r)
    for (int c = 0; c < grid.columns; ++c) {
      const double e = integrate2(density, double(r) / grid.rows, double(r + 1) / grid.rows, double(c) / grid.columns,
                                  double(c + 1) / grid.columns, panels);
      expected[std::size_t(r * grid.columns + c)] = count * e;
      total += e;
    }
  expected[cells] = std::max(0.0, count * (1 - total));
  // Quadrature leaves a rest; it is "none" only where the density says so beyond that.
  if (expected[cells] < 1e-6 * count) expected[cells] = 0;
  TestResult r = chi_square_test(observed, expected);
  std::ostringstream note;
  note << r.note << " integral " << total << ", chi-square " << r.statistic << " at " << r.degrees << " degrees";
  r.note = note.str();
  return r;
}

// A direction on the chart ((1 + cos) / 2, azimuth / 2 pi) about the frame's normal, which keeps area up to 4 pi.
struct SpherePoint {
  double x, y;
};
inline SpherePoint sphere_chart(const LocalFrame<float>& frame, Vec3f w) {
  const Vec3f v = frame.to_local(w);
  const double azimuth = std::atan2(double(v.y), double(v.x)) / (2 * std::numbers::pi);
  return {std::clamp(0.5 + 0.5 * double(v.z), 0.0, 1 - 1e-9), std::clamp(azimuth - std::floor(azimuth), 0.0, 1 - 1e-9)};
}
inline Vec3f sphere_from_chart(const LocalFrame<float>& frame, double x, double y) {
  const double cos = 2 * x - 1, sin = std::sqrt(std::max(0.0, 1 - cos * cos)), azimuth = 2 * std::numbers::pi * y;
  return frame.to_world({float(sin * std::cos(azimuth)), float(sin * std::sin(azimuth)), float(cos)});
}

// Chi-square of directions against a density per steradian. sample(RandomStream<float>&) -> Vec3f, the zero vector for
// "none"; density(Vec3f) -> a number. `frame` turns the grid: put a peak on its normal and raise `panels` for it.
template <class Sample, class DensityFunction>
TestResult chi_square_sphere(Sample sample, DensityFunction density, Grid grid, double count, std::uint32_t seed,
                             const LocalFrame<float>& frame = LocalFrame<float>::from_normal({0, 0, 1}),
                             int panels = 1) {
  return chi_square_square(
      [&](RandomStream<float>& stream) {
        const Vec3f w = sample(stream);
        return dot(w, w) == 0 ? SpherePoint{2, 2} : sphere_chart(frame, w);
      },
      [&](double x, double y) { return 4 * std::numbers::pi * double(density(sphere_from_chart(frame, x, y))); }, grid,
      count, seed, panels);
}

// The lesser p-value of the coarse and the fine grid, doubled (Bonferroni).
template <class Sample, class DensityFunction>
TestResult chi_square_sample_density(Sample sample, DensityFunction density, double count, std::uint32_t seed,
                                     const LocalFrame<float>& frame = LocalFrame<float>::from_normal({0, 0, 1}),
                                     int panels = 1) {
  TestResult coarse = chi_square_sphere(sample, density, coarse_grid, count, seed, frame, 4 * panels);
  TestResult fine = chi_square_sphere(sample, density, fine_grid, count, seed + 1, frame, panels);
  TestResult& worse = coarse.p_value < fine.p_value ? coarse : fine;
  worse.p_value = std::min(1.0, 2 * worse.p_value);
  return worse;
}

}  // namespace montelux::test
