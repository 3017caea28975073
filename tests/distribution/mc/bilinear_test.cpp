// Samples of bilinear tables follow their density, and are found again by its inverse.
#include "mc/bilinear.h"

#include <gtest/gtest.h>

#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

constexpr GridSize grid{7, 5};

// Two tables: any numbers, with rows and columns of zeros; and a steep one.
std::vector<float> two_tables() {
  std::vector<float> values;
  for (std::uint32_t y = 0; y < grid.height; ++y)
    for (std::uint32_t x = 0; x < grid.width; ++x) values.push_back(x == 3 || y == 0 ? 0 : float((x * 5 + y * 3) % 8));
  for (std::uint32_t y = 0; y < grid.height; ++y)
    for (std::uint32_t x = 0; x < grid.width; ++x) values.push_back(float(x * x * y) + 0.1f);
  return values;
}
const TableBlend blends[] = {{{0}, {1}, 1}, {{1}, {1}, 1}, {{0, 1}, {0.25f, 0.75f}, 2}};

TEST(BilinearDensities, samples_follow_the_density) {
  const BilinearDensities tables(two_tables(), grid);
  std::uint32_t seed = 100;
  for (const TableBlend& blend : blends) {
    const auto tested = [&](double lean) {
      return chi_square_square([&](RandomStream<float>& stream) { return tables.sample(blend, stream.next2()); },
                               [&](double x, double y) {
                                 const double p = double(tables.density(blend, {float(x), float(y)}).value);
                                 return p * (x < 0.5 ? 1 - lean : 1 + lean);
                               },
                               Grid{12, 8}, 200000, seed);
    };
    const TestResult r = tested(0);
    EXPECT_GT(r.p_value, sidak_level(family_level, 3)) << r.note;
    EXPECT_LT(tested(0.02).p_value, sidak_level(family_level, 3));
    ++seed;
  }
}

// The density of a blend is the blend of the normalised tables, linear between grid points.
TEST(BilinearDensities, density_is_that_of_the_table) {
  const std::vector<float> values = two_tables();
  const BilinearDensities tables(values, grid);
  double means[2] = {};
  for (int t = 0; t < 2; ++t)
    for (std::uint32_t y = 0; y + 1 < grid.height; ++y)
      for (std::uint32_t x = 0; x + 1 < grid.width; ++x) {
        const float* f = values.data() + std::size_t(t) * grid.points() + y * grid.width + x;
        means[t] += double(f[0] + f[1] + f[grid.width] + f[grid.width + 1]) / 4 / (6 * 4);
      }
  const auto value = [&](int t, std::uint32_t x, std::uint32_t y) {
    return double(values[std::size_t(t) * grid.points() + y * grid.width + x]) / means[t];
  };
  for (std::uint32_t y = 0; y < grid.height; ++y)
    for (std::uint32_t x = 0; x < grid.width; ++x)
      EXPECT_NEAR(tables.density(blends[2], {float(x) / 6, float(y) / 4}).value,
                  0.25 * value(0, x, y) + 0.75 * value(1, x, y), 1e-4);
  const double middle = (value(1, 2, 1) + value(1, 3, 1) + value(1, 2, 2) + value(1, 3, 2)) / 4;
  EXPECT_NEAR(tables.density(blends[1], {2.5f / 6, 1.5f / 4}).value, middle, 1e-5);
}

TEST(BilinearDensities, inverse_gives_the_numbers_of_a_sample) {
  const BilinearDensities tables(two_tables(), grid);
  RandomStream<float> stream(3, 4);
  for (const TableBlend& blend : blends)
    for (int i = 0; i < 5000; ++i) {
      const Vec2f u = stream.next2(), back = tables.invert(blend, tables.sample(blend, u));
      ASSERT_NEAR(back.x, u.x, 2e-5);
      ASSERT_NEAR(back.y, u.y, 2e-5);
    }
}

TEST(BilinearDensities, table_of_zeros_is_uniform) {
  const BilinearDensities tables(std::vector<float>(grid.points()), grid);
  const Vec2f p = tables.sample({}, {0.25f, 0.75f});
  EXPECT_NEAR(p.x, 0.25f, 1e-6f);
  EXPECT_NEAR(p.y, 0.75f, 1e-6f);
  EXPECT_NEAR(tables.density({}, p).value, 1, 1e-6f);
}

TEST(BilinearTables, interpolate_each_component) {
  const BilinearTables<2> tables({0, 10, 1, 20, 2, 30, 3, 40}, {2, 2});
  const std::array<float, 2> at = tables({}, {0.25f, 0.5f});
  EXPECT_NEAR(at[0], 1.25f, 1e-6f);
  EXPECT_NEAR(at[1], 22.5f, 1e-5f);
  // One point along an axis is a constant.
  const BilinearTables<1> column({1, 3}, {1, 2});
  EXPECT_NEAR(column({}, {0.9f, 0.5f})[0], 2, 1e-6f);
}

}  // namespace
}  // namespace montelux
