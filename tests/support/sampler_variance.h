// The variance of a mean over the points of one pass, as it is measured and as theory has it.
#pragma once
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "mc/lattice.h"
#include "mc/point_set.h"
#include "statistics.h"

namespace montelux::test {

// ---- integrands -----------------------------------------------------------------------------------------------------

// A function of the unit square; those of one dimension take x alone, drawn as a single coordinate.
struct SquareIntegrand {
  std::string name;
  bool one_dimensional = false;
  double (*f)(double x, double y);
};

inline double bell(double x, double centre) { return std::exp(-(x - centre) * (x - centre) / 0.18); }
inline double bernoulli2(double x) { return x * (x - 1) + 1.0 / 6; }
inline double bernoulli4(double x) { return x * x * (x - 1) * (x - 1) - 1.0 / 30; }
inline constexpr double periodic_scale = 2;

inline const SquareIntegrand line_exp{"1-D smooth: e^x", true, [](double x, double) { return std::exp(x); }};
inline const SquareIntegrand square_bell{"2-D smooth: Gaussian", false,
                                         [](double x, double y) { return bell(x, 0.4) * bell(y, 0.7); }};
inline const SquareIntegrand square_periodic{
    "2-D periodic: 1 + 2 B2(x), times the same of y", false,
    [](double x, double y) { return (1 + periodic_scale * bernoulli2(x)) * (1 + periodic_scale * bernoulli2(y)); }};
inline const SquareIntegrand square_disk{"2-D edge: disk", false, [](double x, double y) {
                                           return (x - 0.53) * (x - 0.53) + (y - 0.47) * (y - 0.47) < 0.123 ? 1.0 : 0.0;
                                         }};
inline const SquareIntegrand square_triangle{
    "2-D edge: triangle", false,
    [](double x, double y) { return y > 0.13 + 0.17 * x && y < 0.21 + 1.37 * x && y < 1.63 - 1.19 * x ? 1.0 : 0.0; }};
inline const std::vector<SquareIntegrand>& square_integrands() {
  static const std::vector<SquareIntegrand> all{line_exp, square_bell, square_periodic, square_disk, square_triangle};
  return all;
}

// ---- measured -------------------------------------------------------------------------------------------------------

// The mean of f over the n points of a pass, a pack of points at a time. Dimension 0 and 1.
inline double mean_over_pass(const PointSet& set, const SquareIntegrand& f) {
  using F = NativeFloats;
  using U = Uint<F>;
  const std::uint32_t n = set.samples_per_pass;
  double sum = 0;
  for (std::uint32_t first = 0; first < n; first += std::uint32_t(native_lanes)) {
    const U index = min(U(lane_index<F>() + U(first)), U(n - 1));
    const Sampler<F> sampler(set, U(3u), U(5u), index);
    const U d(0u);
    const Vec2<F> u = f.one_dimensional ? Vec2<F>{sampler.get1(d), F(0.0f)} : sampler.get2(d);
    for (int k = 0; k < native_lanes && first + std::uint32_t(k) < n; ++k)
      sum += f.f(double(lane(u, k).x), double(lane(u, k).y));
  }
  return sum / n;
}

inline SampleSummary measured_variance(PointSetKind kind, std::uint32_t n, const SquareIntegrand& f,
                                       std::uint32_t passes = 1000) {
  return variance_summary([&](std::uint32_t pass) { return mean_over_pass({kind, 77, pass, n}, f); }, passes);
}

// The exponent of N by least squares over logarithms, each weighted by its own error; the error of the exponent is the
// noise of the variances alone.
inline Exponent fitted_exponent(const std::vector<double>& n, const std::vector<SampleSummary>& variance) {
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
  for (std::size_t i = 0; i < n.size(); ++i) {
    const double relative = variance[i].standard_error() / variance[i].mean;
    const double weight = 1 / (relative * relative), x = std::log(n[i]), y = std::log(variance[i].mean);
    w += weight, wx += weight * x, wy += weight * y, wxx += weight * x * x, wxy += weight * x * y;
  }
  const double det = w * wxx - wx * wx;
  return {(w * wxy - wx * wy) / det, std::sqrt(w / det)};
}

// ---- theory ---------------------------------------------------------------------------------------------------------

// The variance of f(U), U uniform in the box.
inline double variance_in_box(const SquareIntegrand& f, double ax, double bx, double ay, double by, int panels = 1) {
  const auto moment = [&](int power) {
    if (f.one_dimensional)
      return integrate([&](double x) { return std::pow(f.f(x, 0), power); }, ax, bx, panels) / (bx - ax);
    return integrate2([&](double x, double y) { return std::pow(f.f(x, y), power); }, ax, bx, ay, by, panels) /
           ((bx - ax) * (by - ay));
  };
  const double mean = moment(1);
  return moment(2) - mean * mean;
}

inline double independent_variance(const SquareIntegrand& f, std::uint32_t n) {
  return variance_in_box(f, 0, 1, 0, 1, 8) / n;
}

// One point in each of n equal boxes; n a square where f has two dimensions.
inline double jittered_variance(const SquareIntegrand& f, std::uint32_t n) {
  const auto columns = f.one_dimensional ? n : std::uint32_t(std::lround(std::sqrt(double(n))));
  const std::uint32_t rows = n / columns;
  double sum = 0;
  for (std::uint32_t i = 0; i < columns; ++i)
    for (std::uint32_t j = 0; j < rows; ++j)
      sum += variance_in_box(f, double(i) / columns, double(i + 1) / columns, double(j) / rows, double(j + 1) / rows);
  return sum / (double(n) * n);
}

// The share of the variance of g on [0, 1) that appears when 2^k parts are halved, for k = 0, 1, ...; `levels` of them.
// The integral of g^2 first.
struct LevelVariances {
  double mean_square = 0, mean = 0;
  std::vector<double> at;
};
inline LevelVariances level_variances(const std::function<double(double)>& g, int levels) {
  LevelVariances v;
  std::vector<double> means(std::size_t(1) << levels);
  for (std::size_t i = 0; i < means.size(); ++i) {
    const double width = 1 / double(means.size()), low = double(i) * width;
    means[i] = integrate(g, low, low + width, 1) / width;
  }
  v.at.resize(std::size_t(levels));
  for (int k = levels - 1; k >= 0; --k) {
    double sum = 0;
    const std::size_t half = means.size() / 2;
    for (std::size_t i = 0; i < half; ++i) {
      const double a = means[2 * i], b = means[2 * i + 1];
      sum += (a - b) * (a - b) / 4;
      means[i] = (a + b) / 2;
    }
    means.resize(half);
    v.at[std::size_t(k)] = sum / double(half);
  }
  v.mean = means[0];
  v.mean_square = integrate([&](double x) { return g(x) * g(x); }, 0, 1);
  return v;
}

// Owen-scrambled (0,m,2)-nets on g(x) h(y): the variance is a sum over the levels (k, l) of the integrand's own, each
// with a gain over N (Owen 1997, "Monte Carlo variance of scrambled net quadrature", section 3). Counting the pairs of
// points that share so many digits gives for base 2 and t = 0 the gains 0 for k + l < m - 1, 2 for k + l = m - 1 and 1
// beyond, and for a coordinate alone 0 for k < m and 1 beyond.
inline double scrambled_net_variance(const std::function<double(double)>& g, const std::function<double(double)>& h,
                                     int m) {
  constexpr int levels = 16;
  const LevelVariances a = level_variances(g, levels), b = level_variances(h, levels);
  // What lies beyond the levels at hand is a coordinate's whole variance less that of the levels.
  const auto rest = [](const LevelVariances& v, int from) {
    double sum = 0;
    for (int k = from; k < levels; ++k) sum += v.at[std::size_t(k)];
    // Beyond, halving the parts divides the variance of a smooth function by four.
    return sum + v.at[levels - 1] / 3;
  };
  double total = b.mean * b.mean * rest(a, m) + a.mean * a.mean * rest(b, m);
  for (int k = 0; k < levels; ++k) {
    const int smallest = std::max(0, m - k);
    double of_k = rest(b, std::min(smallest, levels - 1));
    if (m - 1 - k >= 0) of_k += 2 * b.at[std::size_t(m - 1 - k)];
    total += a.at[std::size_t(k)] * of_k;
  }
  return total / double(1u << m);
}

inline double scrambled_net_variance(const SquareIntegrand& f, int m) {
  if (f.one_dimensional) return jittered_variance(f, 1u << m);
  // Both smooth integrands are products; f(x, y0) f(x0, y) / f(x0, y0) says which.
  const double x0 = 0.31, y0 = 0.57, f0 = f.f(x0, y0);
  return scrambled_net_variance([&](double x) { return f.f(x, y0) / f0; }, [&](double y) { return f.f(x0, y); }, m);
}

// Shifted lattices of 2^m points on square_periodic: the sum of the squared Fourier coefficients over the dual lattice,
// which is a mean over the lattice itself of the autocorrelation (Sloan and Joe 1994, section 4; -B4 / 6 is that of
// B2).
inline double lattice_variance_of_periodic(int m) {
  double sum = 0;
  const std::uint32_t n = 1u << m;
  for (std::uint32_t i = 0; i < n; ++i) {
    double product = 1;
    for (std::size_t d = 0; d < 2; ++d) {
      const double x = double(lattice_word(i, lattice_generator[d], 0u)) * 0x1p-32;
      product *= 1 - periodic_scale * periodic_scale * bernoulli4(x) / 6;
    }
    sum += product - 1;
  }
  return sum / n;
}

// A shifted grid of n points on e^x: its mean is c e^(u / n), u uniform.
inline double lattice_variance_of_exp(std::uint32_t n) {
  const double h = 1 / double(n), c = std::expm1(1.0) / (n * std::expm1(h));
  const auto moment = [&](int power) {
    return integrate([&](double u) { return std::pow(std::expm1(u * h), power); }, 0, 1, 4);
  };
  const double mean = moment(1);
  return c * c * (moment(2) - mean * mean);
}

}  // namespace montelux::test
