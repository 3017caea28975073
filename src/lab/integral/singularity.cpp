#include "lab/integral/singularity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/integral/technique.h"
#include "mc/cube_points.h"

namespace montelux::lab {
namespace {

constexpr std::uint32_t probe_pass = 0xffffe000u;  // no pass of a run has this number
constexpr std::uint64_t max_scan = 1u << 14;
constexpr std::size_t max_dimension = 6;  // in more dimensions, shrinking boxes lose the point
constexpr int levels = 40;
constexpr double light = 10;           // a tail index above that of any relevant singularity
constexpr double min_exponent = 0.12;  // logarithms are below it
// The range in which the growth is measured: far enough from the best point found to be independent of its exact
// position, and of the rounding of a difference of squares.
constexpr double near = 1e-6, far = 1e-4;

// The magnitude of the integrand; 0 where it is not a number.
class Magnitude {
 public:
  explicit Magnitude(const Integrand& integrand) : integrand_(integrand) {}
  void evaluate(const std::vector<double>& points, std::span<double> values) {
    integrand_.evaluate({points, integrand_.dimension, values.size()}, values);
    evaluations_ += values.size();
    for (double& v : values) v = std::isnan(v) ? 0 : std::abs(v);
  }
  std::uint64_t evaluations() const { return evaluations_; }

 private:
  const Integrand& integrand_;
  std::uint64_t evaluations_ = 0;
};

struct Top {
  std::vector<double> point;
  double value = 0;

  void take(const std::vector<double>& points, std::span<const double> values) {
    const auto best = std::max_element(values.begin(), values.end());
    if (!(*best > value)) return;
    value = *best;
    for (std::size_t d = 0; d < point.size(); ++d)
      point[d] = points[d * values.size() + std::size_t(best - values.begin())];
  }
};

// Uniform points of the whole cube: the largest values, and the position of the maximum.
LargestTerms scan(Magnitude& f, CubeKey key, std::uint64_t samples, Top& top) {
  const std::size_t dimension = top.point.size(), batch = batch_size(dimension);
  LargestTerms largest(LargestTerms::of_run);
  std::vector<double> points, values;
  for (std::uint64_t done = 0; done < samples; done += values.size()) {
    values.resize(std::size_t(std::min<std::uint64_t>(batch, samples - done)));
    points.resize(dimension * values.size());
    fill_independent(key, {dimension, done, values.size(), points.data()});
    f.evaluate(points, values);
    top.take(points, values);
    for (double& v : values) v = std::isfinite(v) ? v : 0;
    largest.add(values);
  }
  return largest;
}

void climb(Magnitude& f, CubeKey key, std::size_t points_of_level, Top& top) {
  const std::size_t dimension = top.point.size();
  std::vector<double> points(dimension * points_of_level), values(points_of_level);
  double reach = 0.25;
  for (int level = 0; level < levels && std::isfinite(top.value); ++level, reach *= 0.5) {
    fill_independent(key.fork(std::uint32_t(level) + 1), {dimension, 0, points_of_level, points.data()});
    for (std::size_t d = 0; d < dimension; ++d) {
      const double low = std::max(0.0, top.point[d] - reach), high = std::min(1.0, top.point[d] + reach);
      for (std::size_t i = 0; i < points_of_level; ++i) {
        double& x = points[d * points_of_level + i];
        x = low + (high - low) * x;
      }
    }
    f.evaluate(points, values);
    top.take(points, values);
  }
}

// The mean slope of log f against log h over random directions.
double growth_about(Magnitude& f, CubeKey key, const Top& top) {
  constexpr std::size_t directions = 64;
  const std::size_t dimension = top.point.size();
  std::vector<double> u(dimension * directions), points(u.size()), at_far(directions), at_near(directions);
  fill_independent(key, {dimension, 0, directions, u.data()});
  const auto go = [&](double distance, std::span<double> values) {
    for (std::size_t d = 0; d < dimension; ++d)
      for (std::size_t i = 0; i < directions; ++i) {
        const double step = distance * (2 * u[d * directions + i] - 1), x = top.point[d] + step;
        points[d * directions + i] = x > 0 && x < 1 ? x : top.point[d] - step;
      }
    f.evaluate(points, values);
  };
  go(far, at_far), go(near, at_near);
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < directions; ++i) {
    if (!(at_far[i] > 0 && at_near[i] > 0 && std::isfinite(at_far[i]) && std::isfinite(at_near[i]))) continue;
    sum += std::log(at_near[i] / at_far[i]) / std::log(far / near), n += 1;
  }
  return n > 0 ? sum / n : 0;
}

// The set where f is infinite has an integer number c of dimensions less than the cube; P(f > y) is proportional to
// y^-(c / exponent). c is the integer closest to the statistics of the values.
double index_of(const TailFit& fit, double exponent) {
  const double codimension = std::max(1.0, std::round(fit.index * exponent)), index = codimension / exponent;
  const double off = std::abs(index - fit.index) / fit.index * std::sqrt(double(fit.terms));
  return off < 4 ? index : fit.index;
}

}  // namespace

TailProbe probe_tail(const Integrand& integrand, std::uint64_t seed, std::uint64_t budget) {
  const std::size_t dimension = integrand.dimension;
  const auto points_of_level = std::size_t(std::min<std::uint64_t>(64 + 32 * dimension, (budget / 2 - 128) / levels));
  if (dimension > max_dimension || budget < 4096 || points_of_level < 16 * dimension) return {};
  Magnitude f(integrand);
  const CubeKey key = CubeKey::of(seed, probe_pass);
  Top top{std::vector<double>(dimension, 0.5)};
  const std::uint64_t samples = std::min(max_scan, budget / 2);
  const std::vector<double> largest = scan(f, key, samples, top).sorted();
  const TailFit fit = fit_tail(largest, samples);
  TailProbe probe{true, 0, std::numeric_limits<double>::infinity(), 0, f.evaluations()};
  if (!(fit.index < light)) return probe;
  climb(f, key, points_of_level, top);
  const double exponent = growth_about(f, key.fork(0), top);
  probe.evaluations = f.evaluations();
  if (exponent < min_exponent) return probe;
  // A known singularity follows a power law over more terms.
  const TailFit more = fit_tail(largest, 16 * samples);
  probe.exponent = exponent, probe.index = index_of(more, exponent), probe.terms = more.terms;
  return probe;
}

}  // namespace montelux::lab
