// Point sets of the unit cube in double precision: what each construction promises of its points, exactly.
#include "mc/cube_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <set>

#include "mc/lattice.h"
#include "mc/pmj02.h"
#include "mc/point_set.h"
#include "mc/random.h"
#include "mc/sobol.h"

namespace montelux {
namespace {

using Fill = std::function<void(CubeKey, CubeBlock)>;
constexpr std::size_t dimension = 5;
constexpr std::size_t n = 1024;

// Those of the samplers that integrals can use, and those of other methods.
const std::vector<std::pair<std::string_view, Fill>> fills = [] {
  std::vector<std::pair<std::string_view, Fill>> all{{"independent", fill_independent},
                                                     {"antithetic", fill_antithetic}};
  for (const NamedPointSet& entry : point_set_names)
    if (const auto cube = cube_fill(entry.kind)) all.emplace_back(entry.name, cube->fill);
  all.emplace_back("latin", [](CubeKey key, CubeBlock block) { fill_latin(key, n, block); });
  all.emplace_back("grid", [](CubeKey key, CubeBlock block) { fill_grid(key, GridShape::of(dimension, n), block); });
  return all;
}();

TEST(CubePoints, of_four_samplers_serve_integrals) {
  std::set<std::string_view> names;
  for (const NamedPointSet& entry : point_set_names)
    if (cube_fill(entry.kind)) names.insert(entry.name);
  EXPECT_EQ(names, (std::set<std::string_view>{"halton", "lattice", "pmj02", "sobol"}));
}

std::vector<double> points_of(const Fill& fill, std::uint64_t seed, std::uint64_t first = 0, std::size_t count = n) {
  std::vector<double> points(dimension * count);
  fill(CubeKey::of(seed, 0), {dimension, first, count, points.data()});
  return points;
}

// Has every coordinate one point in each of `parts` equal parts?
bool one_in_each_part(std::span<const double> points, std::size_t parts) {
  for (std::size_t d = 0; d < dimension; ++d) {
    std::set<std::size_t> seen;
    for (std::size_t i = 0; i < parts; ++i) seen.insert(std::size_t(points[d * parts + i] * double(parts)));
    if (seen.size() != parts) return false;
  }
  return true;
}

TEST(CubePoints, every_number_lies_inside_the_unit_interval) {
  for (const auto& [name, fill] : fills)
    for (double x : points_of(fill, 7)) {
      ASSERT_GT(x, 0) << name;
      ASSERT_LT(x, 1) << name;
    }
}

TEST(CubePoints, parts_of_a_block_are_the_block) {
  for (const auto& [name, fill] : fills) {
    const std::vector<double> whole = points_of(fill, 3);
    for (const auto& [first, count] :
         {std::pair<std::uint64_t, std::size_t>{0, 64}, {64, 100}, {256, 512}, {1008, 16}}) {
      const std::vector<double> part = points_of(fill, 3, first, count);
      for (std::size_t d = 0; d < dimension; ++d)
        for (std::size_t i = 0; i < count; ++i)
          ASSERT_EQ(part[d * count + i], whole[d * n + first + i]) << name << " " << first;
    }
  }
}

TEST(CubePoints, other_seeds_give_other_points) {
  for (const auto& [name, fill] : fills) EXPECT_NE(points_of(fill, 1), points_of(fill, 2)) << name;
}

TEST(CubePoints, nets_lattices_and_latin_hypercubes_have_one_point_in_each_part_of_every_axis) {
  for (const auto& [name, fill] : fills) {
    const auto kind = point_set_named(name);
    const std::optional<CubeFill> cube = kind ? cube_fill(*kind) : std::nullopt;
    const bool promised = (cube && cube->by_powers_of_two) || name == "latin";
    if (promised) {
      EXPECT_TRUE(one_in_each_part(points_of(fill, 5), n)) << name;
    }
    if (name == "independent") {
      EXPECT_FALSE(one_in_each_part(points_of(fill, 5), n));
    }
  }
  // Of the sequences also every later aligned block.
  for (const Fill& fill : {Fill(fill_sobol), Fill(fill_lattice), Fill(fill_pmj02)}) {
    EXPECT_TRUE(one_in_each_part(points_of(fill, 5, 1024, 1024), 1024));
    EXPECT_TRUE(one_in_each_part(points_of(fill, 5, 512, 256), 256));
  }
}

TEST(CubePoints, a_grid_has_one_point_in_each_box) {
  const GridShape shape = GridShape::of(dimension, n);
  EXPECT_EQ(shape.boxes, 1024u);
  const std::vector<double> points = points_of(fills.back().second, 9);
  std::set<std::size_t> seen;
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t box = 0;
    for (std::size_t d = 0; d < dimension; ++d) box = box * 4 + std::size_t(points[d * n + i] * 4);
    seen.insert(box);
  }
  EXPECT_EQ(seen.size(), n);
}

TEST(CubePoints, grids_of_any_size_have_no_more_boxes_than_requested) {
  for (std::size_t d : {1, 2, 3, 10, 64})
    for (std::uint64_t largest : {1u, 2u, 7u, 100u, 4097u}) {
      const GridShape shape = GridShape::of(d, largest);
      EXPECT_LE(shape.boxes, largest);
      EXPECT_GT(2 * shape.boxes, std::min<std::uint64_t>(largest, 2)) << d;
    }
  EXPECT_EQ(GridShape::of(2, 100).boxes, 100u);
  EXPECT_EQ(GridShape::of(3, 1000).boxes, 1000u);
}

TEST(CubePoints, antithetic_pairs_mirror_each_other) {
  const std::vector<double> points = points_of(fill_antithetic, 2);
  for (std::size_t d = 0; d < dimension; ++d)
    for (std::size_t i = 0; i < n; i += 2) EXPECT_EQ(points[d * n + i] + points[d * n + i + 1], 1.0);
}

TEST(CubePoints, folding_keeps_the_ends_and_doubles_the_middle) {
  std::vector<double> x{0.0, 0.25, 0.5, 0.75, 1.0};
  fold(x);
  EXPECT_EQ(x, (std::vector<double>{0.0, 0.5, 1.0, 0.5, 0.0}));
}

TEST(Lattice, error_in_one_dimension_is_that_of_the_closed_form) {
  // The mean of B_2(i / n) is B_2(0) / n^2, so the squared error is pi^2 / (3 n^2).
  for (int m : {3, 8, 12}) {
    const double points = double(1u << m);
    EXPECT_NEAR(lattice_error({1u}, m) * points * points, std::numbers::pi * std::numbers::pi / 3, 1e-5);
  }
}

TEST(Lattice, the_search_gives_the_same_vector_again_and_a_good_one) {
  const LatticeSearch small{.dimensions = 3, .first_m = 6, .last_m = 10, .candidates = 8, .seed = 1};
  const auto found = construct_lattice(small);
  EXPECT_EQ(found, construct_lattice(small));
  // Better than most random vectors.
  int better = 0;
  RandomStream<float> stream(4, 5);
  for (std::uint32_t k = 0; k < 50; ++k)
    better +=
        lattice_error(found, 10) < lattice_error({1u, stream.bits_at(2 * k) | 1u, stream.bits_at(2 * k + 1) | 1u}, 10);
  EXPECT_GT(better, 40);
}

TEST(Lattice, the_vector_in_use_beats_independent_points_where_there_are_enough) {
  // The mean squared error of n independent points is (prod (1 + pi^2 / (3 j)) - 1) / n with these weights.
  for (std::size_t d : {2, 5, 10})
    for (int m : {6, 10, 14}) {
      if (m < int(d) + 4) continue;
      double independent = 1;
      for (std::size_t j = 1; j <= d; ++j) independent *= 1 + std::numbers::pi * std::numbers::pi / (3 * double(j));
      independent = (independent - 1) / double(1u << m);
      const std::vector<std::uint32_t> generator(lattice_generator.begin(),
                                                 lattice_generator.begin() + std::ptrdiff_t(d));
      EXPECT_LT(lattice_error(generator, m), independent) << d << " " << m;
    }
}

}  // namespace
}  // namespace montelux
