#include "mc/bilinear.h"

#include <algorithm>

#include "mc/linear.h"

namespace montelux {

namespace {

// The last i in [0, n - 2] for which sums(i) <= x.
template <class Sums>
std::uint32_t interval_of(std::uint32_t n, float x, Sums sums) {
  std::uint32_t low = 0, high = n - 1;
  while (high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    (sums(middle) <= x ? low : high) = middle;
  }
  return low;
}

// A part of a cell's mass, in [0, 1], from the distribution function at its ends and at the point.
float part(float low, float high, float x) { return high > low ? clamp((x - low) / (high - low), 0.0f, 1.0f) : 0.0f; }

}  // namespace

GridCell grid_cell(const GridSize& size, Vec2f p) {
  const auto along = [](float x, std::uint32_t n) {
    // A not-a-number becomes zero.
    const float place = x > 0 ? min(x, 1.0f) * float(n - 1) : 0.0f;
    const std::uint32_t cell = n > 1 ? std::min(std::uint32_t(place), n - 2) : 0;
    return std::pair{cell, place - float(cell)};
  };
  const auto [column, x] = along(p.x, size.width);
  const auto [row, y] = along(p.y, size.height);
  return {column, row, x, y};
}

BilinearDensities::BilinearDensities(std::span<const float> values, const GridSize& size)
    : size_(size), values_(values.begin(), values.end()), conditionals_(values.size()) {
  const std::size_t count = values.size() / size.points();
  const double dx = 1.0 / double(size.width - 1), dy = 1.0 / double(size.height - 1);
  marginals_.resize(count * size.height);
  for (std::size_t table = 0; table < count; ++table) {
    float* f = values_.data() + table * size.points();
    float* along_rows = conditionals_.data() + table * size.points();
    float* below = marginals_.data() + table * size.height;
    std::vector<double> sums(size.points()), rows(size.height);
    // By the trapezoidal rule, which is exact here.
    const auto integrate = [&] {
      for (std::size_t row = 0; row < size.height; ++row) {
        const std::size_t first = row * size.width;
        for (std::size_t i = first + 1; i < first + size.width; ++i)
          sums[i] = sums[i - 1] + 0.5 * dx * (double(f[i - 1]) + double(f[i]));
        const double here = sums[first + size.width - 1];
        rows[row] = row == 0 ? 0 : rows[row - 1] + 0.5 * dy * (sums[first - 1] + here);
      }
      return rows.back();
    };
    double total = integrate();
    if (!(total > 0)) {
      std::fill(f, f + size.points(), 1.0f);
      total = integrate();
    }
    const auto normalised = [total](double x) { return float(x / total); };
    std::transform(f, f + size.points(), f, normalised);
    std::ranges::transform(sums, along_rows, normalised);
    std::ranges::transform(rows, below, normalised);
  }
}

Vec2f BilinearDensities::sample(const TableBlend& blend, Vec2f u) const {
  const std::uint32_t last = size_.width - 1;
  const auto below = [&](std::uint32_t i) { return marginal(blend, i); };
  const float v = u.y * below(size_.height - 1);
  const std::uint32_t row = interval_of(size_.height, v, below);
  const float y = sample_linear(point(conditionals_, blend, last, row), point(conditionals_, blend, last, row + 1),
                                part(below(row), below(row + 1), v));

  const auto left_of = [&](std::uint32_t i) { return between_rows(conditionals_, blend, i, row, y); };
  const float w = u.x * left_of(last);
  const std::uint32_t column = interval_of(size_.width, w, left_of);
  const float x =
      sample_linear(between_rows(values_, blend, column, row, y), between_rows(values_, blend, column + 1, row, y),
                    part(left_of(column), left_of(column + 1), w));
  return {(float(column) + x) / float(size_.width - 1), (float(row) + y) / float(size_.height - 1)};
}

Vec2f BilinearDensities::invert(const TableBlend& blend, Vec2f p) const {
  const std::uint32_t last = size_.width - 1;
  const auto [column, row, x, y] = grid_cell(size_, p);
  // The mass of a cell up to the point, by the distribution function at the cell's ends; a + b > 0.
  const auto up_to = [](float low, float high, float a, float b, float t) {
    return a + b > 0 ? low + (high - low) * invert_linear(a, b, t) : low;
  };
  const float v = up_to(marginal(blend, row), marginal(blend, row + 1), point(conditionals_, blend, last, row),
                        point(conditionals_, blend, last, row + 1), y);
  const float all = between_rows(conditionals_, blend, last, row, y);
  const float w =
      up_to(between_rows(conditionals_, blend, column, row, y), between_rows(conditionals_, blend, column + 1, row, y),
            between_rows(values_, blend, column, row, y), between_rows(values_, blend, column + 1, row, y), x);
  return {all > 0 ? min(w / all, 1.0f) : 0.0f, min(v / marginal(blend, size_.height - 1), 1.0f)};
}

Density<Area> BilinearDensities::density(const TableBlend& blend, Vec2f p) const {
  const auto [column, row, x, y] = grid_cell(size_, p);
  return {lerp(x, between_rows(values_, blend, column, row, y), between_rows(values_, blend, column + 1, row, y))};
}

}  // namespace montelux
