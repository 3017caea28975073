// Tabulated densities, constant on equal cells of [0, 1) or [0, 1)^2.
#pragma once
#include <memory>

#include "mc/discrete.h"

namespace montelux {

template <class F>
struct PointSample {
  F x;
  Density<Length, F> density;
};
template <class F>
struct PointSample2 {
  Vec2<F> p;
  Density<Area, F> density;
};

// On [0, 1), from one weight for each of n cells (see cumulative_sums for what they may be).
class PiecewiseConstant1 {
 public:
  explicit PiecewiseConstant1(std::span<const double> weights) : cells_(weights) {}

  std::uint32_t size() const { return cells_.size(); }

  template <class F>
  PointSample<F> sample(F u) const {
    DiscreteSample<F> cell = cells_.sample(u);
    const float n = float(size());
    // The point keeps away from the next cell by more than the rounding of its position.
    F x = (to_float(cell.index) + min(cell.remapped, F(1.0f - n * 0x1p-23f))) / n;
    return {x, {cell.mass.value * n}};
  }
  template <class F>
  Density<Length, F> density(F x) const {
    Mask<F> inside = (x >= F(0.0f)) & (x < F(1.0f));
    return {select(inside, cells_.mass<F>(cell_of(x)).value * float(size()), F(0.0f))};
  }
  template <class F>
  F invert(F x) const {
    Uint<F> i = cell_of(x);
    return cells_.invert(i, clamp(x * float(size()) - to_float(i), 0.0f, 1.0f));
  }

 private:
  template <class F>
  Uint<F> cell_of(F x) const {
    return to_uint(clamp(x * float(size()), 0.0f, float(size() - 1u)));
  }
  DiscreteCdf cells_;
};

// On [0, 1)^2, from width x height weights, row by row (row 0 at y = 0): a row by its marginal mass, then a column
// given the row. Every row and the marginal are tables of sums; at most 2^24 cells along a side.
class PiecewiseConstant2 {
 public:
  PiecewiseConstant2(std::span<const float> weights, std::uint32_t width, std::uint32_t height)
      : PiecewiseConstant2(sums_of(weights, width, height), width, height) {}

  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  // The mean of the weights: the integral of the table as a function on [0, 1)^2.
  double mean() const { return mean_; }

  template <class F>
  PointSample2<F> sample(Vec2<F> u) const {
    Uint<F> row = row_index_.find(rows_.data(), Uint<F>(0u), u.y);
    Interval1<F> y = interval(rows_.data(), row);
    Uint<F> base = row * Uint<F>(width_ + 1u);
    Uint<F> column = column_index_.find(columns_.data(), row, u.x);
    Interval1<F> x = interval(columns_.data(), Uint<F>(base + column));
    F px = place(column, (u.x - x.low) / x.width, width_);
    F py = place(row, (u.y - y.low) / y.width, height_);
    return {{px, py}, {x.width * y.width * (float(width_) * float(height_))}};
  }
  // Density per unit area of the square; zero outside.
  template <class F>
  Density<Area, F> density(Vec2<F> p) const {
    Uint<F> row = cell_of(p.y, height_), column = cell_of(p.x, width_);
    F mass = interval(rows_.data(), row).width *
             interval(columns_.data(), Uint<F>(row * Uint<F>(width_ + 1u) + column)).width;
    Mask<F> inside = (p.x >= F(0.0f)) & (p.x < F(1.0f)) & (p.y >= F(0.0f)) & (p.y < F(1.0f));
    return {select(inside, mass * (float(width_) * float(height_)), F(0.0f))};
  }
  template <class F>
  Vec2<F> invert(Vec2<F> p) const {
    Uint<F> row = cell_of(p.y, height_), column = cell_of(p.x, width_);
    Interval1<F> y = interval(rows_.data(), row);
    Interval1<F> x = interval(columns_.data(), Uint<F>(row * Uint<F>(width_ + 1u) + column));
    F u = x.low + clamp(p.x * float(width_) - to_float(column), 0.0f, 1.0f) * x.width;
    F v = y.low + clamp(p.y * float(height_) - to_float(row), 0.0f, 1.0f) * y.width;
    return {min(u, F(one_minus_epsilon)), min(v, F(one_minus_epsilon))};
  }

 private:
  friend class PiecewiseTiles;
  struct Sums {
    std::vector<float> rows, columns;
    double mean;
  };
  static Sums sums_of(std::span<const float> weights, std::uint32_t width, std::uint32_t height);
  PiecewiseConstant2(Sums sums, std::uint32_t width, std::uint32_t height)
      : width_(width),
        height_(height),
        mean_(sums.mean),
        rows_(std::move(sums.rows)),
        columns_(std::move(sums.columns)),
        row_index_(rows_, height),
        column_index_(columns_, width) {}

  template <class F>
  struct Interval1 {
    F low, width;
  };
  template <class U>
  static auto interval(const float* sums, U i) {
    auto low = gather(sums, i);
    return Interval1<decltype(low)>{low, gather(sums + 1, i) - low};
  }
  // A point in a cell, away from the next cell by more than the rounding.
  template <class F>
  static F place(Uint<F> cell, F rest, std::uint32_t n) {
    return (to_float(cell) + min(rest, F(1.0f - float(n) * 0x1p-23f))) / float(n);
  }
  template <class F>
  static Uint<F> cell_of(F x, std::uint32_t n) {
    return to_uint(clamp(x * float(n), 0.0f, float(n - 1u)));
  }

  std::uint32_t width_, height_;
  double mean_;
  std::vector<float> rows_;     // sums over rows, height + 1
  std::vector<float> columns_;  // sums over the columns of each row, (width + 1) * height
  IntervalIndex row_index_, column_index_;
};

// The parts of a table on side x side equal tiles of the square, whose borders may divide its cells.
class PiecewiseTiles {
 public:
  PiecewiseTiles(std::shared_ptr<const PiecewiseConstant2> table, std::uint32_t side);

  const PiecewiseConstant2& table() const { return *table_; }
  // The probability that the table's own sample lies in each tile, row by row.
  const std::vector<double>& masses() const { return masses_; }
  // A point of that tile, drawn with the table's density over the tile's mass, and the table's density there. Of a tile
  // without mass any point.
  template <class F>
  PointSample2<F> sample(const Uint<F>& column, const Uint<F>& row, Vec2<F> u) const;

 private:
  // Of row number `row` the sum over what is left of x, in columns.
  template <class F>
  F sum_before(const Uint<F>& row, F x) const;

  std::shared_ptr<const PiecewiseConstant2> table_;
  std::uint32_t side_, rows_;   // of a tile at most, parts included
  std::vector<double> masses_;  // by tile
  std::vector<float> sums_;     // of each tile over its rows, rows_ + 1; those beyond the last are 1
};

template <class F>
F PiecewiseTiles::sum_before(const Uint<F>& row, F x) const {
  const std::uint32_t width = table_->width_;
  const Uint<F> column = min(to_uint(x), Uint<F>(width - 1u));
  const auto cell = table_->interval(table_->columns_.data(), Uint<F>(row * Uint<F>(width + 1u) + column));
  return cell.low + (x - to_float(column)) * cell.width;
}

template <class F>
PointSample2<F> PiecewiseTiles::sample(const Uint<F>& column, const Uint<F>& row, Vec2<F> u) const {
  using U = Uint<F>;
  const PiecewiseConstant2& t = *table_;
  // The size of a tile in cells.
  const float across = float(t.width_) / float(side_), down = float(t.height_) / float(side_);
  // Off the upper edge, which belongs to the next cell.
  const auto inside = [](F x, F low, F high) { return max(low, min(x, high * (1.0f - 0x1p-23f))); };

  const U base = (row * U(side_) + column) * U(rows_ + 1u);
  const U place = find_interval<F>(sums_.data(), base, rows_, u.y);
  const auto part = t.interval(sums_.data(), U(base + place));
  const F top = to_float(row) * down, bottom = to_float(row + U(1u)) * down;
  const U y_cell = min(to_uint(top) + place, U(t.height_ - 1u));
  const F from = max(top, to_float(y_cell)), to = min(bottom, to_float(y_cell) + 1.0f);
  const F y = inside(from + (u.y - part.low) / max(part.width, F(1e-37f)) * (to - from), from, to);

  const F left = to_float(column) * across, right = to_float(column + U(1u)) * across;
  const F before = sum_before<F>(y_cell, left), after = sum_before<F>(y_cell, right);
  const F v = min(before + u.x * (after - before), F(one_minus_epsilon));
  const U x_cell = t.column_index_.find(t.columns_.data(), y_cell, v);
  const auto cell = t.interval(t.columns_.data(), U(y_cell * U(t.width_ + 1u) + x_cell));
  const F x = inside(to_float(x_cell) + (v - cell.low) / max(cell.width, F(1e-37f)), left, right);
  const F density = cell.width * t.interval(t.rows_.data(), y_cell).width * (float(t.width_) * float(t.height_));
  return {{x / float(t.width_), y / float(t.height_)}, {density}};
}

}  // namespace montelux
