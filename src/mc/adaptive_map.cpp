#include "mc/adaptive_map.h"

#include <algorithm>
#include <cmath>

namespace montelux {
namespace {

constexpr double damping = 0.3, min_share = 0.1, growth = 0.7;
constexpr std::size_t guide_cells = 256;

// Averages each sum with its neighbours (Lepage 2021, equation 19).
std::vector<double> smoothed(std::span<const double> sums) {
  const std::size_t n = sums.size();
  std::vector<double> s(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double before = sums[i == 0 ? 0 : i - 1], after = sums[i + 1 == n ? i : i + 1];
    s[i] = (before + 6 * sums[i] + after) / 8;
  }
  return s;
}

// Raises weights so that the widths of the new bins, inversely proportional to the weights, grow by no more than
// `growth` times the distance: an edge of the integrand then has narrow bins on both sides.
void grade(std::vector<double>& weights, std::span<const double> x) {
  const std::size_t n = weights.size();
  double total = 0;
  for (double w : weights) total += w;
  const auto width = [&](std::size_t b) { return x[b + 1] - x[b]; };
  std::vector<double> wanted(n);
  for (std::size_t b = 0; b < n; ++b) wanted[b] = width(b) / weights[b] * total / double(n);
  const auto limit = [&](std::size_t b, std::size_t from) {
    wanted[b] = std::min(wanted[b], wanted[from] + growth * 0.5 * (width(b) + width(from)));
  };
  for (std::size_t b = 1; b < n; ++b) limit(b, b - 1);
  for (std::size_t b = n - 1; b-- > 0;) limit(b, b + 1);
  for (std::size_t b = 0; b < n; ++b) weights[b] = width(b) / wanted[b];
}

}  // namespace

AdaptiveMap::AdaptiveMap(std::size_t dimension, std::size_t bins) : dimension_(dimension), bins_(bins) {
  for (std::size_t d = 0; d < dimension; ++d)
    for (std::size_t b = 0; b <= bins; ++b) nodes_.push_back(double(b) / double(bins));
  fit();
}

void AdaptiveMap::fit() {
  coefficients_.resize(dimension_ * 4 * bins_);
  guide_.resize(dimension_ * guide_cells);
  for (std::size_t d = 0; d < dimension_; ++d) {
    const std::span<const double> x = nodes(d);
    const auto width = [&](std::size_t b) { return x[b + 1] - x[b]; };
    const auto slope = [&](std::size_t node) {
      if (node == 0) return std::clamp(1.5 * width(0) - 0.5 * width(1), 0.5 * width(0), 2 * width(0));
      if (node == bins_)
        return std::clamp(1.5 * width(bins_ - 1) - 0.5 * width(bins_ - 2), 0.5 * width(bins_ - 1),
                          2 * width(bins_ - 1));
      return 2 * width(node - 1) * width(node) / (width(node - 1) + width(node));
    };
    double* c = coefficients_.data() + d * 4 * bins_;
    for (std::size_t cell = 0, b = 0; cell < guide_cells; ++cell) {
      while (b + 1 < bins_ && x[b + 1] <= double(cell) / double(guide_cells)) ++b;
      guide_[d * guide_cells + cell] = std::uint16_t(b);
    }
    double left = slope(0);
    for (std::size_t b = 0; b < bins_; ++b) {
      const double right = slope(b + 1), w = width(b);
      c[b] = x[b];
      c[bins_ + b] = left;
      c[2 * bins_ + b] = 3 * w - 2 * left - right;
      c[3 * bins_ + b] = left + right - 2 * w;
      left = right;
    }
  }
}

void AdaptiveMap::apply(std::span<double> points, std::span<double> jacobian) const {
  const std::size_t count = jacobian.size();
  const double scale = double(bins_);
  const int last = int(bins_) - 1;
  for (std::size_t d = 0; d < dimension_; ++d) {
    const double* __restrict c = coefficients_.data() + d * 4 * bins_;
    double* __restrict p = points.data() + d * count;
    double* __restrict j = jacobian.data();
    for (std::size_t i = 0; i < count; ++i) {
      const double y = p[i] * scale;
      const int b = std::min(int(y), last);
      const double t = y - b;
      const double c1 = c[bins_ + b], c2 = c[2 * bins_ + b], c3 = c[3 * bins_ + b];
      p[i] = c[b] + t * (c1 + t * (c2 + t * c3));
      j[i] *= scale * (c1 + t * (2 * c2 + 3 * t * c3));
    }
  }
}

// The bin by the guide, then Newton steps, which converge for a monotone cubic with such slopes; the remaining error is
// below 1e-9 of the density.
void AdaptiveMap::density(std::span<const double> points, std::span<double> density) const {
  constexpr int steps = 5;
  const std::size_t count = density.size();
  std::fill(density.begin(), density.end(), 1.0);
  for (std::size_t d = 0; d < dimension_; ++d) {
    const double* c = coefficients_.data() + d * 4 * bins_;
    const std::uint16_t* guide = guide_.data() + d * guide_cells;
    const std::span<const double> node = nodes(d);
    for (std::size_t i = 0; i < count; ++i) {
      const double x = points[d * count + i];
      std::size_t b = guide[std::min(std::size_t(x * double(guide_cells)), guide_cells - 1)];
      while (b + 1 < bins_ && node[b + 1] <= x) ++b;
      const double c1 = c[bins_ + b], c2 = c[2 * bins_ + b], c3 = c[3 * bins_ + b];
      const double distance = x - c[b];
      double t = distance / (node[b + 1] - node[b]);
      for (int k = 0; k < steps; ++k) {
        const double off = t * (c1 + t * (c2 + t * c3)) - distance, slope = c1 + t * (2 * c2 + 3 * t * c3);
        t = std::clamp(t - off / slope, 0.0, 1.0);
      }
      density[i] /= double(bins_) * (c1 + t * (2 * c2 + 3 * t * c3));
    }
  }
}

void AdaptiveMap::refine(std::span<const double> sums, std::size_t new_bins) {
  std::vector<double> moved;
  for (std::size_t d = 0; d < dimension_; ++d) {
    const std::span<const double> x = nodes(d);
    // For a product integrand, the best density of an axis is proportional to the root of the sum of squared terms.
    // Half that step, and a floor, prevent fitting noise and losing the regions off the axes of a ridge.
    std::vector<double> weights = smoothed(sums.subspan(d * bins_, bins_));
    double total = 0;
    for (double& w : weights) total += w = std::pow(std::max(0.0, w), damping);
    const double floor = total > 0 ? min_share * total / double(bins_) : 1.0;
    for (double& w : weights) w = std::max(w, floor);
    grade(weights, x);
    total = 0;
    for (double w : weights) total += w;

    const double share = total / double(new_bins);
    double reached = 0;
    std::size_t b = 0;
    moved.push_back(0);
    for (std::size_t k = 1; k < new_bins; ++k) {
      const double wanted = share * double(k);
      while (b + 1 < bins_ && reached + weights[b] < wanted) reached += weights[b++];
      const double part = std::clamp((wanted - reached) / weights[b], 0.0, 1.0);
      moved.push_back(std::max(x[b] + part * (x[b + 1] - x[b]), moved.back() + 1e-15));
    }
    moved.push_back(1);
  }
  nodes_ = std::move(moved);
  bins_ = new_bins;
  fit();
}

}  // namespace montelux
