// What path guiding has learned: for every place and orientation of a surface a distribution of directions, and how
// often to use it instead of the BSDF.
#pragma once
#include <array>
#include <vector>

#include "math/square_maps.h"
#include "mc/density.h"
#include "mc/discrete.h"

namespace montelux {

// Where the field is looked up, in every lane: the number of a distribution, and the probability with which it draws
// the direction instead of the BSDF; 0 where training found no gain.
template <class F>
struct GuideSite {
  Uint<F> table;
  F share;
};
template <class F>
struct GuideDirection {
  Vec3<F> wi;  // unit, in world space
  Density<SolidAngle, F> density;
};

// Divides the surfaces of a scene into leaves. Surfaces are distinguished by the axis that their normal is closest to,
// with its sign, or as surfaces that scatter to both sides; each of these seven classes has a binary tree of its own
// over a cube, which halves x, y and z in turn (Mueller, Gross and Novak 2017, "Practical Path Guiding for Efficient
// Light-Transport Simulation", sec. 3.1).
struct GuideTree {
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

// For every leaf a table of directions: constant on cells of equal solid angle. Immutable.
class GuideField {
 public:
  static constexpr std::uint32_t side = 16, cells = side * side;

  // The relative weights of the cells, and the probability to use them.
  struct Table {
    std::array<float, cells> weights{};
    float share = 0;
  };
  // `tables`: at least as many as the tree has leaves. Weights must be finite and not negative; where all are zero they
  // count as equal.
  GuideField(GuideTree tree, const std::vector<Table>& tables);

  // As GuideTree::leaf_at. Where a lane is off the share is 0.
  template <class F>
  GuideSite<F> at(const Vec3<F>& p, const Vec3<F>& n, Mask<F> on) const {
    const Uint<F> table = tree_.leaf_at<F>(p, n, on);
    return {table, select(on, gather(shares_.data(), table), F(0.0f))};
  }
  template <class F>
  GuideDirection<F> sample(const GuideSite<F>& site, Vec2<F> u) const;
  // With which sample() draws the unit direction.
  template <class F>
  Density<SolidAngle, F> density(const GuideSite<F>& site, const Vec3<F>& wi) const {
    return {gather(densities_.data(), Uint<F>(site.table * Uint<F>(cells) + cell_of(wi)))};
  }
  // The cell of a unit direction.
  template <class F>
  static Uint<F> cell_of(const Vec3<F>& w) {
    const Vec2<F> at = square_from_sphere(w);
    const auto part = [](F x) { return to_uint(clamp(x * float(side), 0.0f, float(side) - 1.0f)); };
    return part(at.y) * Uint<F>(side) + part(at.x);
  }

  const GuideTree& tree() const { return tree_; }
  std::size_t tables() const { return shares_.size(); }
  float share(std::uint32_t table) const { return shares_[table]; }
  std::size_t bytes() const { return 4 * (tree_.nodes.size() + sums_.size() + densities_.size() + shares_.size()); }

 private:
  static constexpr std::uint32_t sums_of_table = (side + 1) * (side + 1);
  void add(const Table& table);

  GuideTree tree_;
  std::vector<float> sums_;       // for each table: running sums over rows, then over the columns of each row
  std::vector<float> densities_;  // of its cells, per steradian
  std::vector<float> shares_;
};

template <class F>
Uint<F> GuideTree::class_of(const Vec3<F>& n) {
  using U = Uint<F>;
  const F x = abs(n.x), y = abs(n.y), z = abs(n.z);
  const Mask<F> by_x = (x >= y) & (x >= z), by_y = (!by_x) & (y >= z);
  const F along = select(by_x, n.x, select(by_y, n.y, n.z));
  const U axis = select(by_x, U(0u), select(by_y, U(2u), U(4u)));
  const U one_sided = axis + select(along < F(0.0f), U(1u), U(0u));
  return select(along == F(0.0f), U(6u), one_sided);
}

template <class F>
Uint<F> GuideTree::leaf_at(const Vec3<F>& p, const Vec3<F>& n, Mask<F> on) const {
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

template <class F>
GuideDirection<F> GuideField::sample(const GuideSite<F>& site, Vec2<F> u) const {
  using U = Uint<F>;
  const U base = site.table * U(sums_of_table);
  const auto draw = [&](const U& first, F x, U& index) {
    index = find_interval<F>(sums_.data(), first, side, x);
    const F low = gather(sums_.data(), U(first + index));
    const F width = gather(sums_.data(), U(first + index + U(1u))) - low;
    // Away from the next cell by more than the rounding of the place.
    return (to_float(index) + clamp((x - low) / max(width, F(1e-30f)), 0.0f, 1.0f - float(side) * 0x1p-23f)) /
           float(side);
  };
  U row, column;
  const F y = draw(base, u.y, row);
  const F x = draw(base + (row + U(1u)) * U(side + 1), u.x, column);
  return {sphere_from_square(Vec2<F>{x, y}),
          {gather(densities_.data(), U(site.table * U(cells) + row * U(side) + column))}};
}

}  // namespace montelux
