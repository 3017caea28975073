#include "mc/point_set.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "mc/digital.h"
#include "mc/halton.h"
#include "mc/sobol.h"

namespace montelux {
namespace {

std::vector<Vec2f> points(PointSet set, std::uint32_t x, std::uint32_t y, std::uint32_t dimension) {
  std::vector<Vec2f> p;
  for (std::uint32_t i = 0; i < set.samples_per_pass; ++i) p.push_back(Sampler<float>(set, x, y, i).get2(dimension));
  return p;
}

bool one_in_each_cell(const std::vector<Vec2f>& p, int columns, int rows) {
  std::set<int> seen;
  for (Vec2f q : p) seen.insert(int(q.x * float(columns)) * rows + int(q.y * float(rows)));
  return int(seen.size()) == columns * rows && p.size() == seen.size();
}

TEST(PointSet, names_lead_back_to_kinds) {
  for (const NamedPointSet& entry : point_set_names) {
    EXPECT_EQ(name_of(entry.kind), entry.name);
    EXPECT_EQ(point_set_named(entry.name), entry.kind);
  }
  EXPECT_FALSE(point_set_named("sobl").has_value());
}

TEST(PointSet, every_elementary_interval_holds_one_point_of_a_scrambled_net) {
  for (PointSetKind kind : {PointSetKind::padded_sobol, PointSetKind::blue_noise})
    for (std::uint32_t n : {1u, 2u, 8u, 16u, 64u, 256u})
      for (std::uint32_t pass = 0; pass < 3; ++pass)
        for (std::uint32_t d : {0u, 2u, 7u, 613u}) {
          PointSet set{kind, 11, pass, n};
          auto p = points(set, 17 + pass, 5, d);
          for (std::uint32_t columns = 1; columns <= n; columns *= 2)
            EXPECT_TRUE(one_in_each_cell(p, int(columns), int(n / columns))) << name_of(kind) << " " << n << " " << d;
        }
}

TEST(PointSet, a_set_without_its_second_matrix_fails_the_elementary_intervals) {
  std::vector<Vec2f> p;
  for (std::uint32_t i = 0; i < 64; ++i)
    p.push_back(
        {fraction_of_reversed<float>(scramble_upwards(i, 77u)), fraction_of_reversed<float>(scramble_upwards(i, 78u))});
  EXPECT_FALSE(one_in_each_cell(p, 8, 8));
}

TEST(PointSet, sobol_keeps_one_point_in_each_stratum_of_every_dimension) {
  for (std::uint32_t d = 0; d < sobol_dimensions; ++d) {
    PointSet set{PointSetKind::sobol, 3, 1, 256};
    std::set<int> strata;
    for (std::uint32_t i = 0; i < 256; ++i) strata.insert(int(Sampler<float>(set, 4, 9, i).get1(d) * 256.0f));
    EXPECT_EQ(strata.size(), 256u) << d;
  }
}

TEST(PointSet, first_two_dimensions_of_sobol_form_a_net) {
  auto p = points({PointSetKind::sobol, 3, 1, 256}, 4, 9, 0);
  for (int columns = 1; columns <= 256; columns *= 2) EXPECT_TRUE(one_in_each_cell(p, columns, 256 / columns));
}

TEST(PointSet, unscrambled_sobol_points_are_those_of_the_published_sequence) {
  // Bratley and Fox 1988, points in the order without Gray code; dimensions 0 to 4 of Joe and Kuo's numbers.
  const float expected[6][5] = {{0, 0, 0, 0, 0},
                                {0.5f, 0.5f, 0.5f, 0.5f, 0.5f},
                                {0.25f, 0.75f, 0.75f, 0.75f, 0.25f},
                                {0.75f, 0.25f, 0.25f, 0.25f, 0.75f},
                                {0.125f, 0.625f, 0.375f, 0.125f, 0.125f},
                                {0.625f, 0.125f, 0.875f, 0.625f, 0.625f}};
  for (std::uint32_t i = 0; i < 4; ++i)
    for (std::uint32_t d = 0; d < 5; ++d)
      EXPECT_EQ(fraction_of_reversed<float>(sobol_reversed(i, d)), expected[i][d]) << i << " " << d;
  for (std::uint32_t d : {0u, 1u})
    for (std::uint32_t i = 4; i < 6; ++i) EXPECT_EQ(fraction_of_reversed<float>(sobol_reversed(i, d)), expected[i][d]);
}

TEST(PointSet, sobol_polynomials_are_primitive_and_distinct) {
  std::set<std::uint32_t> seen;
  for (const SobolSeed& seed : sobol_seeds) {
    const auto s = std::uint32_t(seed.degree);
    const std::uint32_t polynomial = 1u << s | seed.middle << 1 | 1u;
    EXPECT_TRUE(seen.insert(polynomial).second);
    // Primitive: x takes on all 2^s - 1 nonzero residues.
    std::uint32_t power = 1, order = 0;
    do {
      power <<= 1;
      if ((power >> s & 1u) != 0) power ^= polynomial;
      ++order;
    } while (power != 1u && order < 4096);
    EXPECT_EQ(order, (1u << s) - 1u);
    for (std::uint32_t i = 0; i < s; ++i) EXPECT_TRUE((seed.m[i] & 1u) == 1u && seed.m[i] < (2u << i));
  }
}

TEST(PointSet, halton_keeps_one_point_in_each_digit_cell) {
  for (std::uint32_t d : {0u, 1u, 2u, 5u, 30u, 127u}) {
    const std::uint32_t base = halton_bases[d];
    PointSet set{PointSetKind::halton, 3, 2, base * base};
    std::set<std::uint32_t> first, second;
    for (std::uint32_t i = 0; i < base * base && i < 4096; ++i) {
      const double u = double(Sampler<float>(set, 4, 9, i).get1(d));
      if (i < base) first.insert(std::uint32_t(u * base));
      second.insert(std::uint32_t(u * base * base));
    }
    // A point may round over an edge between cells.
    EXPECT_GE(first.size() + 1, base);
    EXPECT_GE(second.size() + 4, std::min<std::size_t>(base * base, 4096));
  }
}

TEST(PointSet, stratified_fills_every_stratum_once_for_any_number_of_points) {
  for (std::uint32_t n : {1u, 2u, 3u, 7u, 16u, 30u, 100u, 257u}) {
    PointSet set{PointSetKind::stratified, 5, 0, n};
    std::set<int> strata;
    for (std::uint32_t i = 0; i < n; ++i) strata.insert(int(double(Sampler<float>(set, 1, 2, i).get1(6)) * n + 1e-5));
    EXPECT_GE(strata.size() + 1, n);
    // In two dimensions: so many columns, and in a column of m cells one point in each m-th part.
    const auto columns = std::size_t(std::lround(std::sqrt(double(n))));
    std::vector<std::set<int>> rows(columns);
    const std::uint32_t base = n / std::uint32_t(columns), tall = n % std::uint32_t(columns);
    std::size_t filled = 0;
    for (Vec2f q : points(set, 1, 2, 6)) {
      double edge = 0;
      for (std::size_t c = 0; c < columns; ++c) {
        const std::uint32_t cells = base + (c < tall ? 1u : 0u);
        if (double(q.x) >= edge && double(q.x) < edge + double(cells) / n)
          filled += rows[c].insert(int(q.y * float(cells))).second ? 1 : 0;
        edge += double(cells) / n;
      }
    }
    EXPECT_GE(filled + 1, n);
  }
}

TEST(PointSet, uniform_grid_is_the_centres_of_the_cells_in_every_pass_and_site) {
  EXPECT_EQ(point_set_named("uniform-grid"), PointSetKind::uniform_grid);
  EXPECT_EQ(name_of(PointSetKind::uniform_grid), "uniform-grid");
  const auto one = points({PointSetKind::uniform_grid, 5, 3, 1}, 7, 8, 2);
  EXPECT_EQ(one[0].x, 0.5f);
  EXPECT_EQ(one[0].y, 0.5f);
  const auto p = points({PointSetKind::uniform_grid, 5, 0, 16}, 1, 2, 6);
  const auto q = points({PointSetKind::uniform_grid, 6, 9, 16}, 3, 4, 6);
  EXPECT_TRUE(one_in_each_cell(p, 4, 4));
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(p[i].x, q[i].x);
    EXPECT_EQ(p[i].y, q[i].y);
    EXPECT_EQ(p[i].x * 8, std::round(p[i].x * 8));
  }
}

TEST(PointSet, permute_is_a_bijection) {
  for (std::uint32_t n : {1u, 2u, 3u, 5u, 64u, 100u, 1000u}) {
    std::set<std::uint32_t> seen;
    for (std::uint32_t i = 0; i < n; ++i) seen.insert(permute(i, n, 0xabcdu + n));
    EXPECT_EQ(seen.size(), n);
    EXPECT_LT(*seen.rbegin(), n);
  }
}

TEST(PointSet, a_lane_holds_the_bits_of_the_float_sampler) {
  using F = NativeFloats;
  for (const NamedPointSet& entry : point_set_names) {
    PointSet set{entry.kind, 9, 4, 13};
    for (std::uint32_t round = 0; round < 40; ++round) {
      Uint<F> x, y, index, d;
      for (int k = 0; k < native_lanes; ++k) {
        const std::uint32_t r = mix_bits(round * 64u + std::uint32_t(k));
        set_lane(x, k, r % 300u), set_lane(y, k, (r >> 9) % 200u), set_lane(index, k, (r >> 17) % 13u);
        set_lane(d, k, (r >> 3) % 260u);
      }
      Sampler<F> sampler(set, x, y, index);
      F one = sampler.get1(d), random = sampler.stream(d).next();
      Vec2<F> two = sampler.get2(d);
      for (int k = 0; k < native_lanes; ++k) {
        Sampler<float> single(set, lane(x, k), lane(y, k), lane(index, k));
        EXPECT_EQ(lane(one, k), single.get1(lane(d, k))) << entry.name;
        EXPECT_EQ(lane(two, k).x, single.get2(lane(d, k)).x) << entry.name;
        EXPECT_EQ(lane(two, k).y, single.get2(lane(d, k)).y) << entry.name;
        EXPECT_EQ(lane(random, k), single.stream(lane(d, k)).next()) << entry.name;
        EXPECT_TRUE(lane(two, k).x >= 0 && lane(two, k).x < 1 && lane(two, k).y >= 0 && lane(two, k).y < 1);
      }
    }
  }
}

TEST(PointSet, the_z_order_of_a_large_grid_falls_into_squares_and_keeps_its_nets) {
  auto p = points({PointSetKind::blue_noise, 1, 0, 4096}, 50123, 20321, 4);
  for (int columns = 1; columns <= 4096; columns *= 2) EXPECT_TRUE(one_in_each_cell(p, columns, 4096 / columns));
}

}  // namespace
}  // namespace montelux
