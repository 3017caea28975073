#include "lab/integral/density_sampler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lab/integral/technique.h"
#include "mc/sobol.h"

namespace montelux::lab {
namespace {

constexpr std::uint32_t table_purpose = 0x7ab1eu, bound_purpose = 0xb0u;

// Checks the value of a density for sampling: finite and not negative.
double checked(double p) {
  if (!std::isfinite(p) || p < 0)
    throw std::invalid_argument(fmt::format("a density has the value {}; it must be finite and not negative", p));
  return p;
}

}  // namespace

DensitySampler::DensitySampler(const UserDensity& density, std::size_t dimension)
    : user_(density), dimension_(dimension), sampling_(density.sampling) {
  if (sampling_ == DensitySampling::automatic)
    sampling_ = density.inverse  ? DensitySampling::inverse
                : dimension <= 3 ? DensitySampling::table
                                 : DensitySampling::rejection;
  if (sampling_ == DensitySampling::inverse && !density.inverse)
    throw std::invalid_argument("the inverse of a density is missing");
  if (sampling_ == DensitySampling::table && dimension > 3)
    throw std::invalid_argument("a table of a density has at most three dimensions");
  if (sampling_ == DensitySampling::table) tabulate();
  if (sampling_ == DensitySampling::rejection) find_bound();
}

void DensitySampler::tabulate() {
  constexpr std::size_t cells_of_axis[3] = {4096, 192, 40};
  constexpr std::size_t each = 4;  // points in a cell, one in each of its parts
  cells_ = cells_of_axis[dimension_ - 1];
  std::size_t total = 1;
  for (std::size_t d = 0; d < dimension_; ++d) total *= cells_;
  std::vector<double> points(dimension_ * total), values(total), mass(total);
  for (std::size_t k = 0; k < each; ++k) {
    fill_sobol(CubeKey::of(table_purpose, std::uint32_t(k)), {dimension_, 0, total, points.data()});
    std::size_t stride = 1;
    for (std::size_t d = 0; d < dimension_; ++d, stride *= cells_)
      for (std::size_t i = 0; i < total; ++i) {
        double& x = points[d * total + i];
        x = (double(i / stride % cells_) + x) / double(cells_);
      }
    user_.density({points, dimension_, total}, values);
    for (std::size_t i = 0; i < total; ++i) mass[i] += checked(values[i]);
  }
  // A cell that seems empty next to one that is not may contain a little: it gets a small share, so that it is sampled.
  std::vector<double> floors(total);
  std::size_t stride = 1;
  for (std::size_t d = 0; d < dimension_; ++d, stride *= cells_)
    for (std::size_t i = 0; i < total; ++i) {
      const std::size_t place = i / stride % cells_;
      if (place > 0) floors[i] = std::max(floors[i], 1e-3 * mass[i - stride]);
      if (place + 1 < cells_) floors[i] = std::max(floors[i], 1e-3 * mass[i + stride]);
    }
  double sum = 0;
  cumulated_.push_back(0);
  for (std::size_t i = 0; i < total; ++i) cumulated_.push_back(sum += std::max(mass[i], floors[i]));
  if (!(sum > 0)) throw std::invalid_argument("a density is 0 at all tested points");
  for (double& c : cumulated_) c /= sum;
}

// The largest density found from a point by searching along one axis after the other.
double DensitySampler::climb(std::vector<double> top) const {
  constexpr std::size_t steps = 65, sweeps = 3;
  std::vector<double> line(dimension_ * steps), values(steps);
  double largest = 0;
  for (std::size_t turn = 0; turn < sweeps * dimension_; ++turn) {
    const std::size_t axis = turn % dimension_;
    for (std::size_t d = 0; d < dimension_; ++d)
      for (std::size_t i = 0; i < steps; ++i)
        line[d * steps + i] = d == axis ? std::clamp(double(i) / double(steps - 1), 1e-9, 1 - 1e-9) : top[d];
    user_.density({line, dimension_, steps}, values);
    const std::size_t best = std::size_t(std::max_element(values.begin(), values.end()) - values.begin());
    if (!(checked(values[best]) > largest)) continue;
    largest = values[best];
    top[axis] = line[axis * steps + best];
  }
  return largest;
}

void DensitySampler::find_bound() {
  constexpr std::size_t tried = 1u << 14;
  std::vector<double> points(dimension_ * tried), values(tried);
  fill_sobol(CubeKey::of(bound_purpose, 0), {dimension_, 0, tried, points.data()});
  user_.density({points, dimension_, tried}, values);
  for (double p : values) checked(p);
  const std::size_t best = std::size_t(std::max_element(values.begin(), values.end()) - values.begin());
  std::vector<double> top(dimension_);
  for (std::size_t d = 0; d < dimension_; ++d) top[d] = points[d * tried + best];
  const double largest = std::max(values[best], climb(std::move(top)));
  if (!(largest > 0)) throw std::invalid_argument("a density is 0 at all tested points");
  bound_ = user_.bound.value_or(1.2 * largest);
}

DensitySampler::Drawn DensitySampler::sample(CubeKey key, std::uint64_t first, std::size_t count,
                                             std::span<double> points) const {
  if (sampling_ == DensitySampling::table) return sample_by_table(key, first, count, points);
  if (sampling_ == DensitySampling::rejection) return sample_by_rejection(key, first, count, points);
  std::vector<double> u(dimension_ * count);
  fill_independent(key, {dimension_, first, count, u.data()});
  (*user_.inverse)({u, dimension_, count}, points);
  return {count};
}

DensitySampler::Drawn DensitySampler::sample_by_table(CubeKey key, std::uint64_t first, std::size_t count,
                                                      std::span<double> points) const {
  std::vector<double> choice(count);
  fill_independent(key, {dimension_, first, count, points.data()});
  fill_independent(key.fork(table_purpose), {1, first, count, choice.data()});
  for (std::size_t i = 0; i < count; ++i) {
    const auto above = std::upper_bound(cumulated_.begin(), cumulated_.end() - 1, choice[i]);
    std::size_t cell = std::size_t(above - cumulated_.begin()) - 1;
    for (std::size_t d = 0; d < dimension_; ++d, cell /= cells_) {
      double& x = points[d * count + i];
      x = (double(cell % cells_) + x) / double(cells_);
    }
  }
  return {count};
}

DensitySampler::Drawn DensitySampler::sample_by_rejection(CubeKey key, std::uint64_t first, std::size_t count,
                                                          std::span<double> points) const {
  constexpr std::uint64_t max_proposals = 1u << 20;  // per point
  const CubeKey own = key.fork(std::uint32_t(first)).fork(std::uint32_t(first >> 32));
  const std::size_t batch = batch_size(dimension_);
  std::vector<double> candidates(dimension_ * batch), height(batch), values(batch);
  std::size_t kept = 0;
  for (std::uint64_t tried = 0; kept < count; tried += batch) {
    if (tried > max_proposals * count)
      throw std::invalid_argument(
          "rejection accepts fewer than one point in a million: give the inverse of the density");
    fill_independent(own, {dimension_, tried, batch, candidates.data()});
    fill_independent(own.fork(bound_purpose), {1, tried, batch, height.data()});
    user_.density({candidates, dimension_, batch}, values);
    for (std::size_t i = 0; i < batch; ++i) {
      if (checked(values[i]) > bound_)
        throw std::invalid_argument(
            fmt::format("a density has the value {:g}, above the bound {:g} of its rejection: give a larger bound",
                        values[i], bound_));
      if (height[i] * bound_ >= values[i]) continue;
      for (std::size_t d = 0; d < dimension_; ++d) points[d * count + kept] = candidates[d * batch + i];
      if (++kept == count) return {tried + i + 1};
    }
  }
  return {0};
}

void DensitySampler::density(PointBatch points, std::span<double> values) const {
  if (sampling_ != DensitySampling::table) {
    user_.density(points, values);
    for (double& p : values) p *= user_.scale;
    return;
  }
  const double volume = std::pow(double(cells_), -double(dimension_));
  for (std::size_t i = 0; i < points.count; ++i) {
    std::size_t cell = 0, stride = 1;
    for (std::size_t d = 0; d < dimension_; ++d, stride *= cells_)
      cell += stride * std::min(cells_ - 1, std::size_t(points[d][i] * double(cells_)));
    values[i] = (cumulated_[cell + 1] - cumulated_[cell]) / volume;
  }
}

}  // namespace montelux::lab
