// Tabulated densities, constant on equal cells of [0, 1) or [0, 1)^2.
#pragma once
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

}  // namespace montelux
