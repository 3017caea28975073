// What nets and lattices promise of their points holds exactly: at every prefix of a power of the base each elementary
// interval has its count of points.
#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <vector>

#include "mc/cube_points.h"
#include "mc/digital.h"
#include "mc/halton.h"
#include "mc/lattice.h"
#include "mc/pmj02.h"
#include "mc/point_set.h"

namespace montelux {
namespace {

std::vector<Vec2f> points(PointSet set, std::uint32_t dimension) {
  std::vector<Vec2f> p;
  for (std::uint32_t i = 0; i < set.samples_per_pass; ++i) p.push_back(Sampler<float>(set, 12, 5, i).get2(dimension));
  return p;
}

// Whether each of columns x rows boxes has as many of the n points from `first` on as every other.
bool evenly_spread(const std::vector<Vec2f>& p, std::size_t first, std::size_t n, std::uint32_t columns,
                   std::uint32_t rows) {
  std::vector<std::size_t> counts(std::size_t(columns) * rows);
  for (std::size_t i = first; i < first + n; ++i)
    ++counts[std::size_t(double(p[i].x) * columns) * rows + std::size_t(double(p[i].y) * rows)];
  return std::ranges::all_of(counts, [&](std::size_t c) { return c == n / counts.size(); });
}

// Every elementary interval in base 2 of volume 1/n, and so every larger one, of the n points from `first` on.
bool is_net(const std::vector<Vec2f>& p, std::size_t first, std::uint32_t n) {
  for (std::uint32_t columns = 1; columns <= n; columns *= 2)
    if (!evenly_spread(p, first, n, columns, n / columns)) return false;
  return true;
}

bool every_prefix_is_a_net(const std::vector<Vec2f>& p) {
  for (std::uint32_t n = 1; n <= p.size(); n *= 2)
    if (!is_net(p, 0, n)) return false;
  return true;
}

TEST(Nets, every_elementary_interval_of_every_prefix_has_its_count) {
  for (PointSetKind kind : {PointSetKind::padded_sobol, PointSetKind::blue_noise, PointSetKind::pmj02})
    for (std::uint32_t pass = 0; pass < 8; ++pass)
      for (std::uint32_t d : {0u, 2u, 7u, 64u, 613u})
        EXPECT_TRUE(every_prefix_is_a_net(points({kind, 11, pass, 512}, d))) << name_of(kind) << " " << d;
  for (std::uint32_t pass = 0; pass < 8; ++pass) {
    EXPECT_TRUE(every_prefix_is_a_net(points({PointSetKind::sobol, 11, pass, 512}, 0)));
    // Past the tabulated dimensions the sequence is padded by nets.
    EXPECT_TRUE(every_prefix_is_a_net(points({PointSetKind::sobol, 11, pass, 512}, 200)));
  }
}

TEST(Nets, every_aligned_block_of_pmj02_is_a_net) {
  const auto p = points({PointSetKind::pmj02, 3, 9, 256}, 6);
  for (std::uint32_t n = 1; n <= 128; n *= 2)
    for (std::uint32_t first = 0; first < 256; first += n) EXPECT_TRUE(is_net(p, first, n)) << first << " " << n;
}

TEST(Nets, pmj02_is_progressive_its_points_do_not_depend_on_how_many_follow) {
  const auto few = points({PointSetKind::pmj02, 3, 9, 13}, 6), many = points({PointSetKind::pmj02, 3, 9, 3000}, 6);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].x, many[i].x);
    EXPECT_EQ(few[i].y, many[i].y);
  }
}

TEST(Nets, a_flipped_digit_or_a_missing_matrix_is_found) {
  const auto good = points({PointSetKind::pmj02, 3, 9, 64}, 6);
  ASSERT_TRUE(every_prefix_is_a_net(good));
  for (int digit = 1; digit <= 6; ++digit) {
    auto bad = good;
    const float unit = std::ldexp(1.0f, -digit);
    bad[37].x += std::fmod(std::floor(bad[37].x / unit), 2.0f) == 0 ? unit : -unit;
    EXPECT_FALSE(every_prefix_is_a_net(bad)) << digit;
  }
  std::vector<Vec2f> without;
  for (std::uint32_t i = 0; i < 64; ++i)
    without.push_back(
        {fraction_of_reversed<float>(scramble_upwards(i, 77u)), fraction_of_reversed<float>(scramble_upwards(i, 78u))});
  EXPECT_FALSE(every_prefix_is_a_net(without));
  // Jittered strata are no sequence, and independent points no net.
  EXPECT_FALSE(every_prefix_is_a_net(points({PointSetKind::stratified, 3, 9, 64}, 6)));
  EXPECT_FALSE(every_prefix_is_a_net(points({PointSetKind::independent, 3, 9, 64}, 6)));
}

TEST(Nets, halton_has_its_count_in_every_elementary_interval_of_bases_two_and_three) {
  for (std::uint32_t pass = 0; pass < 8; ++pass) {
    const auto p = points({PointSetKind::halton, 11, pass, 1728}, 0);
    for (std::uint32_t columns = 1; columns <= 64; columns *= 2)
      for (std::uint32_t rows = 1; rows <= 27; rows *= 3)
        EXPECT_TRUE(evenly_spread(p, 0, std::size_t(columns) * rows, columns, rows)) << columns << " x " << rows;
    auto shifted = p;
    for (Vec2f& q : shifted) q.y = std::fmod(q.y + 0.2f, 1.0f);
    EXPECT_FALSE(evenly_spread(shifted, 0, 72, 8, 9));
  }
}

// The one-dimensional projections of 2^m points are 2^m points at equal distances, and no two points share one: the
// lattice is fully projection regular (L'Ecuyer and Lemieux 2000).
bool equally_spaced(std::vector<double> x) {
  std::ranges::sort(x);
  for (std::size_t i = 1; i < x.size(); ++i)
    if (std::abs(x[i] - x[i - 1] - 1.0 / double(x.size())) > 2.0 / (1 << 23)) return false;
  return true;
}

TEST(Lattice, every_prefix_is_fully_projection_regular) {
  for (std::uint32_t d : {0u, 1u, 2u, 17u, 63u, 64u, 65u, 300u})
    for (std::uint32_t n = 2; n <= 1024; n *= 2) {
      std::vector<double> x, first, second;
      for (std::uint32_t i = 0; i < n; ++i) {
        const Sampler<float> s(PointSet{PointSetKind::lattice, 7, 2, 1024}, 3, 4, i);
        x.push_back(double(s.get1(d)));
        first.push_back(double(s.get2(d).x)), second.push_back(double(s.get2(d).y));
      }
      EXPECT_TRUE(equally_spaced(x)) << d << " " << n;
      EXPECT_TRUE(equally_spaced(first) && equally_spaced(second)) << d << " " << n;
    }
}

TEST(Lattice, sampler_and_cube_share_one_formula_up_to_the_shift) {
  constexpr std::size_t dimensions = 9, n = 64;
  std::vector<double> cube(dimensions * n);
  fill_lattice(CubeKey::of(5, 1), {dimensions, 0, n, cube.data()});
  for (std::uint32_t d = 0; d < dimensions; ++d) {
    const auto at = [&](std::uint32_t i) {
      return double(Sampler<float>(PointSet{PointSetKind::lattice, 7, 2, n}, 3, 4, i).get1(d)) - cube[d * n + i];
    };
    for (std::uint32_t i = 1; i < n; ++i) {
      const double difference = at(i) - at(0);
      EXPECT_NEAR(difference, std::round(difference), 2e-7);
    }
  }
}

TEST(Lattice, a_generator_with_an_even_component_is_found) {
  std::vector<double> x;
  for (std::uint32_t i = 0; i < 64; ++i) x.push_back(double(lattice_word(i, lattice_generator[3] + 1, 99u)) * 0x1p-32);
  EXPECT_FALSE(equally_spaced(x));
}

TEST(Nets, cube_pairs_of_pmj02_are_nets_at_every_prefix) {
  constexpr std::size_t dimensions = 6, n = 1024;
  std::vector<double> x(dimensions * n);
  fill_pmj02(CubeKey::of(5, 1), {dimensions, 0, n, x.data()});
  for (std::size_t pair = 0; pair < dimensions; pair += 2) {
    std::vector<Vec2f> p;
    for (std::size_t i = 0; i < n; ++i) p.push_back({float(x[pair * n + i]), float(x[(pair + 1) * n + i])});
    EXPECT_TRUE(every_prefix_is_a_net(p)) << pair;
  }
  // Across pairs nothing is promised: first and third coordinate are no net.
  std::vector<Vec2f> across;
  for (std::size_t i = 0; i < n; ++i) across.push_back({float(x[i]), float(x[2 * n + i])});
  EXPECT_FALSE(every_prefix_is_a_net(across));
}

}  // namespace
}  // namespace montelux
