// Tables of functions and of densities on the unit square, bilinear between the points of a regular grid. Several
// tables share one grid, and a look-up blends some of them: linear interpolation over further parameters.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "math/vec.h"
#include "mc/piecewise.h"

namespace montelux {

// Grid points along x and y; the first and the last are on the edges of the square.
struct GridSize {
  std::uint32_t width = 1, height = 1;
  std::size_t points() const { return std::size_t(width) * height; }
};

// The tables of a look-up and their weights, which are not negative and sum to one.
struct TableBlend {
  std::array<std::uint32_t, 4> tables{};
  std::array<float, 4> weights{1, 0, 0, 0};
  int count = 1;
};

// The cell of a grid with a point of the square, which is clamped to it, and the place in the cell, in [0, 1].
struct GridCell {
  std::uint32_t column, row;
  float x, y;
};
GridCell grid_cell(const GridSize& size, Vec2f p);

// Functions with N components. `values`: table by table, row by row (row 0 at y = 0), the components of a grid point
// side by side.
template <int N>
class BilinearTables {
 public:
  using Value = std::array<float, N>;

  BilinearTables(std::vector<float> values, const GridSize& size) : values_(std::move(values)), size_(size) {}

  Value operator()(const TableBlend& blend, Vec2f p) const {
    const GridCell cell = grid_cell(size_, p);
    const std::size_t right = cell.column + 1 < size_.width ? N : 0, up = cell.row + 1 < size_.height ? N : 0;
    Value sum{};
    for (int k = 0; k < blend.count; ++k) {
      const float* at = values_.data() + N * (blend.tables[std::size_t(k)] * size_.points() +
                                              std::size_t(cell.row) * size_.width + cell.column);
      const float* above = at + up * size_.width;
      const float weight = blend.weights[std::size_t(k)];
      for (std::size_t c = 0; c < N; ++c)
        sum[c] += weight * lerp(cell.y, lerp(cell.x, at[c], at[right + c]), lerp(cell.x, above[c], above[right + c]));
    }
    return sum;
  }

 private:
  std::vector<float> values_;
  GridSize size_;
};

// Densities per unit area of the square. A row, hence y, is sampled by its marginal density, then x given y. The
// distribution functions of a blend are the blends of those of its tables.
class BilinearDensities {
 public:
  // `values`: as for BilinearTables, finite and not negative, at least 2 x 2 for each table. Each table is normalised;
  // one that is zero everywhere becomes the uniform density.
  BilinearDensities(std::span<const float> values, const GridSize& size);

  // u.y decides on y, u.x on x.
  Vec2f sample(const TableBlend& blend, Vec2f u) const;
  // The numbers from which sample() makes p; zero for x where the row of p has no density.
  Vec2f invert(const TableBlend& blend, Vec2f p) const;
  Density<Area> density(const TableBlend& blend, Vec2f p) const;

 private:
  // The tables' values at one index of arrays with that many entries for each table.
  static float blended(const std::vector<float>& values, std::size_t entries, const TableBlend& blend, std::size_t i) {
    float sum = 0;
    for (int k = 0; k < blend.count; ++k)
      sum += blend.weights[std::size_t(k)] * values[blend.tables[std::size_t(k)] * entries + i];
    return sum;
  }
  float marginal(const TableBlend& blend, std::uint32_t row) const {
    return blended(marginals_, size_.height, blend, row);
  }
  float point(const std::vector<float>& values, const TableBlend& blend, std::uint32_t column,
              std::uint32_t row) const {
    return blended(values, size_.points(), blend, std::size_t(row) * size_.width + column);
  }
  // Interpolated between two rows at y in [0, 1].
  float between_rows(const std::vector<float>& values, const TableBlend& blend, std::uint32_t column, std::uint32_t row,
                     float y) const {
    return lerp(y, point(values, blend, column, row), point(values, blend, column, row + 1));
  }

  GridSize size_;
  std::vector<float> values_;        // at the grid points
  std::vector<float> conditionals_;  // integrals along the grid's rows, from x = 0 to each grid point
  std::vector<float> marginals_;     // integrals over the square below each row
};

}  // namespace montelux
