#include "lab/statement/density_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mc/cube_points.h"

namespace montelux::lab {
namespace {

constexpr std::uint64_t check_samples = 1u << 16;
constexpr std::size_t batch = 512;

// Calls f(points) for batches of independent uniform points.
template <class Function>
void for_uniform_points(std::size_t dimension, std::uint32_t purpose, Function f) {
  std::vector<double> memory(dimension * batch);
  for (std::uint64_t done = 0; done < check_samples; done += batch) {
    fill_independent(CubeKey::of(0, 0xc4ecc5u).fork(purpose), {dimension, done, batch, memory.data()});
    f(PointBatch{memory, dimension, batch});
  }
}

}  // namespace

DensityCheck check_density(const BatchFunction& density, std::size_t dimension) {
  DensityCheck check;
  std::vector<double> p(batch);
  for_uniform_points(dimension, 1, [&](PointBatch points) {
    density(points, p);
    for (std::size_t i = 0; i < batch; ++i) {
      check.non_finite += !std::isfinite(p[i]);
      if (!(p[i] < 0) || check.negative_at) continue;
      check.negative_at.emplace();
      for (std::size_t d = 0; d < dimension; ++d) check.negative_at->push_back(points[d][i]);
    }
  });
  // The adaptive method finds narrow peaks, too.
  const Problem problem{.integrand = {dimension, density}};
  const IntegralResult result = integrate(problem, *parse_method("vegas"), {.samples = 1u << 18});
  check.integral = result.mean, check.standard_error = result.standard_error;
  return check;
}

ControlCheck check_control(const ControlVariate& control, std::size_t dimension) {
  const Problem problem{.integrand = {dimension, control.evaluate}};
  const IntegralResult r = integrate(problem, *parse_method("qmc:passes=16"), {.samples = check_samples});
  ControlCheck check{false, r.mean, r.standard_error};
  if (!std::isfinite(r.standard_error) || r.non_finite > 0) return check;
  const double reach = student_t_quantile(1 - 0.5 * ControlCheck::level, 15) * r.standard_error;
  const double off = std::abs(r.mean - control.integral);
  check.contradicts = off > reach && off > 1e-9 * std::max(std::abs(r.mean), std::abs(control.integral));
  return check;
}

MissedIntegral missed_by(const Problem& problem, std::span<const UserDensity> densities) {
  std::vector<double> f(batch), p(batch), all(batch);
  Moments missed, whole;
  for_uniform_points(problem.integrand.dimension, 2, [&](PointBatch points) {
    std::ranges::fill(all, 0.0);
    for (const UserDensity& density : densities) {
      density.density(points, p);
      for (std::size_t i = 0; i < batch; ++i) all[i] += std::abs(p[i]);
    }
    problem.integrand.evaluate(points, f);
    for (std::size_t i = 0; i < batch; ++i) {
      missed.add(all[i] == 0 ? f[i] : 0.0);
      whole.add(std::abs(f[i]));
    }
  });
  const bool rounding = std::sqrt(missed.m2 / double(check_samples)) <= 1e-12 * whole.mean;
  if (rounding && std::abs(missed.mean) <= 1e-12 * whole.mean) return {};
  return {missed.mean, missed.standard_error()};
}

double inverse_disagreement(const UserDensity& density, std::size_t dimension) {
  constexpr int functions = 4;
  const auto value = [](int k, double u) { return k == 0 ? u : std::cos(k * std::numbers::pi * u); };
  const Method method = *parse_method("qmc:passes=16");
  const auto mean = [&](BatchFunction f) {
    return integrate({.integrand = {dimension, std::move(f)}}, method, {.samples = 1u << 14});
  };
  double worst = 0;
  for (std::size_t d = 0; d < dimension; ++d)
    for (int k = 0; k < functions; ++k) {
      const IntegralResult drawn = mean([&](PointBatch points, std::span<double> values) {
        std::vector<double> image(points.dimension * points.count);
        (*density.inverse)(points, image);
        for (std::size_t i = 0; i < points.count; ++i) values[i] = value(k, image[d * points.count + i]);
      });
      const IntegralResult weighted = mean([&](PointBatch points, std::span<double> values) {
        density.density(points, values);
        for (std::size_t i = 0; i < points.count; ++i) values[i] *= density.scale * value(k, points[d][i]);
      });
      if (drawn.non_finite > 0) return std::numeric_limits<double>::infinity();
      const double error = std::hypot(drawn.standard_error, weighted.standard_error);
      worst = std::max(worst, std::abs(drawn.mean - weighted.mean) / std::max(error, 1e-6));
    }
  return worst;
}

}  // namespace montelux::lab
