// Distributions of directions that a render has learned, one for every place and orientation of a surface.
#pragma once
#include <array>
#include <vector>

#include "math/square_maps.h"
#include "mc/density.h"
#include "mc/discrete.h"

namespace montelux {

// Where the field is looked up, in every lane: the number of a distribution, and for path guiding the probability with
// which it draws the direction instead of the BSDF; 0 where training found no gain.
template <class F>
struct FieldSite {
  Uint<F> table;
  F share;
};
template <class F>
struct FieldDirection {
  Vec3<F> wi;  // unit
  Density<SolidAngle, F> density;
};
// A cell of the square map of directions, and a point of [0, 1)^2 that says where in it.
template <class F>
struct FieldCell {
  Uint<F> column, row;
  Vec2<F> rest;
};

// Divides the surfaces of a scene into leaves. Surfaces are distinguished by the axis that their normal is closest to,
// with its sign, or as surfaces that scatter to both sides; each of these seven classes has a binary tree of its own
// over a cube, which halves x, y and z in turn (Mueller, Gross and Novak 2017, "Practical Path Guiding for Efficient
// Light-Transport Simulation", sec. 3.1).
struct PlaceTree {
  static constexpr std::uint32_t classes = 7, leaf = 0x80000000u;
  static constexpr int bits_per_axis = 10, max_depth = 3 * bits_per_axis;

  Vec3f low{};  // of the cube; places beyond it belong to its border
  float size = 1;
  // A word for each node, first those of the roots: the number of the first of two consecutive children, or of a leaf
  // with the bit `leaf`.
  std::vector<std::uint32_t> nodes = std::vector<std::uint32_t>(classes, leaf);

  // The number of the leaf with a point of a surface, and its normal on the side that scatters; zero: both sides do.
  // 0 where a lane is off.
  template <class F>
  Uint<F> leaf_at(const Vec3<F>& p, const Vec3<F>& n, Mask<F> on) const;
  template <class F>
  static Uint<F> class_of(const Vec3<F>& n);
};

// For every leaf a table of directions: constant on side x side cells of equal solid angle. Immutable.
template <std::uint32_t side_of_table>
class DirectionField {
 public:
  static constexpr std::uint32_t side = side_of_table, cells = side * side;

  // The relative weights of the cells, and the probability that FieldSite has.
  struct Table {
    std::array<float, cells> weights{};
    float share = 0;
  };
  // `tables`: at least as many as the tree has leaves. Weights must be finite and not negative; where all are zero they
  // count as equal.
  DirectionField(PlaceTree tree, const std::vector<Table>& tables);

  // As PlaceTree::leaf_at. Where a lane is off the share is 0.
  template <class F>
  FieldSite<F> at(const Vec3<F>& p, const Vec3<F>& n, Mask<F> on) const {
    const Uint<F> table = tree_.leaf_at<F>(p, n, on);
    return {table, select(on, gather(shares_.data(), table), F(0.0f))};
  }
  template <class F>
  FieldDirection<F> sample(const FieldSite<F>& site, Vec2<F> u) const;
  // With which sample() draws the unit direction.
  template <class F>
  Density<SolidAngle, F> density(const FieldSite<F>& site, const Vec3<F>& wi) const {
    return {density_of(site.table, cell_of(wi))};
  }
  // The cell alone, with a probability of density_of() times 4 pi / cells.
  template <class F>
  FieldCell<F> sample_cell(const Uint<F>& table, Vec2<F> u) const;
  template <class U>
  auto density_of(const U& table, const U& cell) const {
    return gather(densities_.data(), U(table * U(cells) + cell));
  }
  // The cell of a unit direction, or of its point of the square.
  template <class F>
  static Uint<F> cell_of(const Vec3<F>& w) {
    return cell_at(square_from_sphere(w));
  }
  template <class F>
  static Uint<F> cell_at(const Vec2<F>& at) {
    const auto part = [](F x) { return to_uint(clamp(x * float(side), 0.0f, float(side) - 1.0f)); };
    return part(at.y) * Uint<F>(side) + part(at.x);
  }

  const PlaceTree& tree() const { return tree_; }
  std::size_t tables() const { return shares_.size(); }
  float share(std::uint32_t table) const { return shares_[table]; }
  std::size_t bytes() const { return 4 * (tree_.nodes.size() + sums_.size() + densities_.size() + shares_.size()); }

 private:
  static constexpr std::uint32_t sums_of_table = (side + 1) * (side + 1);
  void add(const Table& table);

  PlaceTree tree_;
  std::vector<float> sums_;       // for each table: running sums over rows, then over the columns of each row
  std::vector<float> densities_;  // of its cells, per steradian
  std::vector<float> shares_;
};

template <class F>
Uint<F> PlaceTree::class_of(const Vec3<F>& n) {
  using U = Uint<F>;
  const F x = abs(n.x), y = abs(n.y), z = abs(n.z);
  const Mask<F> by_x = (x >= y) & (x >= z), by_y = (!by_x) & (y >= z);
  const F along = select(by_x, n.x, select(by_y, n.y, n.z));
  const U axis = select(by_x, U(0u), select(by_y, U(2u), U(4u)));
  const U one_sided = axis + select(along < F(0.0f), U(1u), U(0u));
  return select(along == F(0.0f), U(6u), one_sided);
}

template <class F>
Uint<F> PlaceTree::leaf_at(const Vec3<F>& p, const Vec3<F>& n, Mask<F> on) const {
  using U = Uint<F>;
  constexpr float steps = 1 << bits_per_axis;
  const float scale = steps / size;
  const auto part = [&](F x, float from) { return to_uint(clamp((x - from) * scale, 0.0f, steps - 1.0f)); };
  const std::array<U, 3> place{part(p.x, low.x), part(p.y, low.y), part(p.z, low.z)};
  // Lanes that are off may lie anywhere.
  U word = gather(nodes.data(), select(on, class_of<F>(n), U(0u)));
  for (int level = 0; level < max_depth; ++level) {
    const Mask<F> inside = on & (word < U(leaf));
    if (!any(inside)) break;
    const U half = (place[std::size_t(level % 3)] >> (bits_per_axis - 1 - level / 3)) & U(1u);
    word = select(inside, gather(nodes.data(), select(inside, U(word + half), U(0u))), word);
  }
  return select(on, U(word & U(~leaf)), U(0u));
}

template <std::uint32_t side_of_table>
template <class F>
FieldCell<F> DirectionField<side_of_table>::sample_cell(const Uint<F>& table, Vec2<F> u) const {
  using U = Uint<F>;
  const U base = table * U(sums_of_table);
  const auto draw = [&](const U& first, F x, U& index) {
    index = find_interval<F>(sums_.data(), first, side, x);
    const F low = gather(sums_.data(), U(first + index));
    const F width = gather(sums_.data(), U(first + index + U(1u))) - low;
    // Away from the next cell by more than the rounding of the place.
    return clamp((x - low) / max(width, F(1e-30f)), 0.0f, 1.0f - float(side) * 0x1p-23f);
  };
  FieldCell<F> cell;
  cell.rest.y = draw(base, u.y, cell.row);
  cell.rest.x = draw(base + (cell.row + U(1u)) * U(side + 1), u.x, cell.column);
  return cell;
}

template <std::uint32_t side_of_table>
template <class F>
FieldDirection<F> DirectionField<side_of_table>::sample(const FieldSite<F>& site, Vec2<F> u) const {
  const FieldCell<F> cell = sample_cell<F>(site.table, u);
  const Vec2<F> at{(to_float(cell.column) + cell.rest.x) / float(side),
                   (to_float(cell.row) + cell.rest.y) / float(side)};
  return {sphere_from_square(at), {density_of(site.table, Uint<F>(cell.row * Uint<F>(side) + cell.column))}};
}

// For path guiding, and for the sky.
using GuideField = DirectionField<16>;
using SkyDirections = DirectionField<32>;
extern template class DirectionField<16>;
extern template class DirectionField<32>;

}  // namespace montelux
