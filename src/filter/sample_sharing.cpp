#include "filter/sample_sharing.h"

#include <algorithm>
#include <cmath>

namespace montelux {

namespace {

constexpr int cells = 1024;

// Rounds the weights to multiples of 2^-20 that sum to 1, as they do except for the steps of the table: so that sums of
// equal samples are exact.
void make_exact(std::vector<float>& weights) {
  constexpr double unit = 0x1p-20, steps = 1e-3;
  double sum = 0, rest = 1;
  for (const float w : weights) sum += double(w);
  if (std::abs(sum - 1) > steps) return;
  for (float& w : weights) w = float(std::round(double(w) / sum / unit) * unit), rest -= double(w);
  float& largest = *std::max_element(weights.begin(), weights.end());
  largest = float(double(largest) + rest);
}

}  // namespace

SampleSharing::SampleSharing(const Filter& filter)
    : filter_(filter), x_(axis(true, filter.radius().x)), y_(axis(false, filter.radius().y)) {}

SampleSharing::Axis SampleSharing::axis(bool along_x, float radius) const {
  Axis axis;
  axis.reach = std::max(int(std::ceil(radius - 0.5f)), 0);
  // The sum over the grid of pixels at offset x.
  const auto sum = [&](double x) {
    double all = 0;
    for (int j = -axis.reach; j <= axis.reach; ++j) all += double(along(along_x, float(x - j)));
    return all;
  };
  constexpr int steps = 16 * cells;
  std::vector<double> sums(steps);
  double integral = 0;
  for (int i = 0; i < steps; ++i) integral += sums[std::size_t(i)] = sum((i + 0.5) / steps - 0.5);
  integral /= steps;
  axis.scale = 1 / integral;
  double magnitude = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = -axis.reach; j <= axis.reach; ++j)
      magnitude += std::abs(double(along(along_x, float((i + 0.5) / steps - 0.5 - j)))) / steps;
  axis.magnitude = magnitude * std::abs(axis.scale);
  // Filters with negative lobes may have a sum near zero somewhere, where weights must stay bounded.
  constexpr double least = 0.25;
  std::vector<double> cdf{0};
  for (const double s : sums) cdf.push_back(cdf.back() + std::max(std::abs(s * axis.scale), least) / steps);
  std::size_t i = 0;
  for (int k = 0; k <= cells; ++k) {
    const double target = cdf.back() * k / cells;
    while (i + 1 < steps && cdf[i + 1] < target) ++i;
    axis.quantiles.push_back((double(i) + (target - cdf[i]) / (cdf[i + 1] - cdf[i])) / steps - 0.5);
  }
  return axis;
}

float SampleSharing::draw(const Axis& axis, bool is_x, float u, std::vector<float>& weights) const {
  const double scaled = double(u) * cells, cell = std::clamp(std::floor(scaled), 0.0, double(cells - 1));
  const double low = axis.quantiles[std::size_t(cell)], width = axis.quantiles[std::size_t(cell) + 1] - low;
  const double offset = low + (scaled - cell) * width, inverse_density = width * cells;
  for (int j = -axis.reach; j <= axis.reach; ++j)
    weights.push_back(float(double(along(is_x, float(offset - j))) * axis.scale * inverse_density));
  make_exact(weights);
  return float(offset);
}

SampleSharing::Weights SampleSharing::at(Vec2f u) const {
  Weights weights;
  weights.offset.x = draw(x_, true, u.x, weights.x);
  weights.offset.y = draw(y_, false, u.y, weights.y);
  return weights;
}

double SampleSharing::noise() const {
  const auto mean_square = [&](const Axis& axis, bool is_x) {
    double all = 0;
    std::vector<float> weights;
    for (int i = 0; i < cells; ++i) {
      weights.clear();
      draw(axis, is_x, (float(i) + 0.5f) / cells, weights);
      for (const float w : weights) all += double(w) * double(w) / cells;
    }
    return all;
  };
  return mean_square(x_, true) * mean_square(y_, false);
}

double SampleSharing::noise_of_own_samples() const { return x_.magnitude * x_.magnitude * y_.magnitude * y_.magnitude; }

}  // namespace montelux
