// Distributions on a line and tables of weights.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mc/discrete.h"
#include "mc/linear.h"
#include "mc/piecewise.h"
#include "mc/power.h"
#include "mc/rejection.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

const double level = sidak_level(family_level, 66);
constexpr double samples = 200000;

float bent(float u) { return std::pow(u, 1.06f); }

// Counts of draws in [low, high) on a grid of `cells`, against the integrals of the density.
template <class Draw, class DensityFunction>
double line_p_value(Draw draw, DensityFunction density, double low, double high, int cells) {
  const auto n = std::size_t(cells);
  std::vector<double> observed(n), expected(n);
  RandomStream<float> stream(7, 77);
  for (double i = 0; i < samples; i += 1)
    observed[std::min(n - 1, std::size_t((double(draw(stream)) - low) / (high - low) * cells))] += 1;
  double total = 0;
  for (std::size_t c = 0; c < n; ++c) {
    const double h = (high - low) / cells;
    const double e =
        integrate([&](double x) { return double(density(float(x))); }, low + double(c) * h, low + double(c + 1) * h, 4);
    total += e;
    expected[c] = samples * e;
  }
  EXPECT_NEAR(total, 1, 2e-4);
  return chi_square_test(observed, expected).p_value;
}

template <class Sample, class DensityFunction, class Invert>
void check_line(Sample sample, DensityFunction density, Invert invert, double low, double high) {
  for (int cells : {20, 400}) {
    const double fair = line_p_value([&](auto& s) { return sample(s.next()); }, density, low, high, cells);
    EXPECT_GT(fair, level);
  }
  EXPECT_LT(line_p_value([&](auto& s) { return sample(bent(s.next())); }, density, low, high, 20), level);
  RandomStream<float> stream(8, 9);
  for (int i = 0; i < 1000; ++i) {
    const float u = stream.next();
    EXPECT_NEAR(invert(sample(u)), u, 1e-4);
  }
  RandomStream<NativeFloats> lanes(lane_index<NativeFloats>(), Uint<NativeFloats>(5u));
  const NativeFloats u = lanes.next(), x = sample(u);
  for (int k = 0; k < native_lanes; ++k) EXPECT_EQ(lane(x, k), sample(lane(u, k)));
}

TEST(Power, inversion_matches_density) {
  for (float n : {0.5f, 1.0f, 3.0f, 12.0f})
    check_line([=](auto u) { return sample_power(decltype(u)(n), u); },
               [=](float x) { return power_density(n, x).value; }, [=](float x) { return invert_power(n, x); }, 0, 1);
}

TEST(Power, largest_of_uniform_numbers_matches_density) {
  const auto draw = [](auto& s) { return sample_power_by_maximum<float>(3, s); };
  EXPECT_GT(line_p_value(
                draw, [](float x) { return power_density(3.0f, x).value; }, 0, 1, 50),
            level);
  // One number too few must be seen.
  const auto fewer = [](auto& s) { return sample_power_by_maximum<float>(2, s); };
  EXPECT_LT(line_p_value(
                fewer, [](float x) { return power_density(3.0f, x).value; }, 0, 1, 50),
            level);
}

TEST(Tent, inversion_matches_density) {
  check_line([](auto u) { return sample_tent(u); }, [](float x) { return tent_density(x).value; },
             [](float x) { return invert_tent(x); }, -1, 1);
}

TEST(Linear, inversion_matches_density) {
  for (auto [a, b] : {std::pair{0.0f, 1.0f}, {3.0f, 1.0f}, {1.0f, 1.0f}, {1.0f, 0.0f}})
    check_line(
        [a = a, b = b](auto u) {
          using F = decltype(u);
          return sample_linear(F(a), F(b), u);
        },
        [a = a, b = b](float x) { return linear_density(a, b, x).value; },
        [a = a, b = b](float x) { return invert_linear(a, b, x); }, 0, 1);
}

TEST(Rejection, points_under_a_curve_match_it_with_the_efficiency_of_the_areas) {
  // 4 x^3 under the box of height 4: a quarter is accepted.
  AcceptanceRate rate;
  const auto draw = [&](auto& s) {
    const auto r = sample_under_curve([](float x) { return 4 * x * x * x; }, 4, s);
    rate.add(r);
    return r.value;
  };
  EXPECT_GT(line_p_value(
                draw, [](float x) { return power_density(3.0f, x).value; }, 0, 1, 50),
            level);
  EXPECT_GT(z_test(rate.efficiency(), rate.standard_error(), 0.25).p_value, level);
  EXPECT_LT(z_test(rate.efficiency(), rate.standard_error(), 0.255).p_value, level);
  // A bound that cuts the peak off must be seen.
  const auto cut = [&](auto& s) { return sample_under_curve([](float x) { return 4 * x * x * x; }, 3, s).value; };
  EXPECT_LT(line_p_value(
                cut, [](float x) { return power_density(3.0f, x).value; }, 0, 1, 50),
            level);
}

const std::vector<double> weights{0, 3, 0, 0, 1e-3, 7, 2, 2, 0, 11, 0.5, 0};

template <class Table>
double index_p_value(const Table& table, const std::vector<double>& truth, float power) {
  std::vector<double> observed(truth.size()), expected(truth.size());
  double total = 0;
  for (double w : truth) total += w;
  RandomStream<float> stream(1, 3);
  for (double i = 0; i < samples; i += 1) observed[table.sample(std::pow(stream.next(), power)).index] += 1;
  for (std::size_t i = 0; i < truth.size(); ++i) expected[i] = samples * truth[i] / total;
  return chi_square_test(observed, expected).p_value;
}

template <class Table>
void check_discrete(const Table& table, const std::vector<double>& truth) {
  EXPECT_GT(index_p_value(table, truth, 1.0f), level);
  EXPECT_LT(index_p_value(table, truth, 1.2f), level);
  double mass = 0, total = 0;
  for (double w : truth) total += w;
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    mass += double(table.template mass<float>(i).value);
    EXPECT_NEAR(table.template mass<float>(i).value, truth[i] / total, 2e-7);
  }
  EXPECT_NEAR(mass, 1, 1e-6);
  // The rest of the number is uniform again, whichever element was chosen.
  EXPECT_GT(
      line_p_value([&](auto& s) { return table.sample(s.next()).remapped; }, [](float) { return 1.0f; }, 0, 1, 30),
      level);
  EXPECT_LT(line_p_value([&](auto& s) { return bent(table.sample(s.next()).remapped); }, [](float) { return 1.0f; }, 0,
                         1, 30),
            level);
  RandomStream<NativeFloats> stream(lane_index<NativeFloats>(), Uint<NativeFloats>(5u));
  for (int i = 0; i < 50; ++i) {
    const NativeFloats u = stream.next();
    const DiscreteSample<NativeFloats> many = table.sample(u);
    for (int k = 0; k < native_lanes; ++k) {
      const DiscreteSample<float> one = table.sample(lane(u, k));
      EXPECT_EQ(lane(many.index, k), one.index);
      EXPECT_EQ(lane(many.remapped, k), one.remapped);
      EXPECT_EQ(lane(many.mass.value, k), one.mass.value);
    }
  }
}

TEST(DiscreteCdf, choice_matches_mass) {
  const DiscreteCdf table(weights);
  check_discrete(table, weights);
  RandomStream<float> stream(8, 9);
  for (int i = 0; i < 1000; ++i) {
    const float u = stream.next();
    const auto s = table.sample(u);
    EXPECT_NEAR(table.invert(s.index, s.remapped), u, 2e-7);
  }
}

std::vector<double> many_weights() {
  std::vector<double> many;
  for (int i = 0; i < 1000; ++i) many.push_back(i % 17 == 0 ? 0 : 1.0 / (1 + i % 29));
  return many;
}

TEST(AliasTable, choice_matches_mass) {
  check_discrete(AliasTable(weights), weights);
  const AliasTable table(many_weights());
  EXPECT_GT(index_p_value(table, many_weights(), 1.0f), level);
}

TEST(AliasTable, inverse_is_one_to_one_onto_the_numbers_that_lead_to_an_element) {
  for (const std::vector<double>& w : {weights, many_weights(), std::vector<double>{5}, std::vector<double>{0, 0}}) {
    const AliasTable table(w);
    double total = 0;
    for (double x : w) total += x;
    for (std::uint32_t i = 0; i < table.size(); ++i) {
      if (total > 0 && w[i] == 0) continue;
      // The inverse is linear in pieces of slope 1 / mass, so that evenly spaced v lead to numbers at least this far
      // apart.
      const int n = 200;
      const double apart = double(table.mass<float>(i).value) / n;
      std::vector<float> found;
      for (int k = 0; k < n; ++k) {
        const float u = table.invert<float>(i, (float(k) + 0.5f) / n);
        ASSERT_EQ(table.sample(u).index, i) << u;
        found.push_back(u);
      }
      std::sort(found.begin(), found.end());
      if (apart < 0x1p-20) continue;
      // Where one piece ends and the next begins two numbers may be nearer, their pieces being cut at different phases.
      int near = 0;
      for (int k = 1; k < n; ++k) near += double(found[std::size_t(k)] - found[std::size_t(k) - 1]) < apart - 0x1p-21;
      std::set<int> bins;
      for (float u : found) bins.insert(int(u * float(table.size())));
      EXPECT_LE(near, int(bins.size()) - 1) << i;
    }
  }
}

TEST(AliasTable, inverse_of_samples_is_uniform) {
  const auto number = [](const AliasTable& table, auto& s, float fault) {
    const std::uint32_t i = table.sample(s.next()).index;
    return table.invert<float>(i, std::pow(s.next(), fault));
  };
  for (const std::vector<double>& w : {weights, many_weights()}) {
    const AliasTable table(w);
    const auto p_value = [&](auto draw, int cells) {
      return line_p_value(
          draw, [](float) { return 1.0f; }, 0, 1, cells);
    };
    for (int cells : {12, 360}) EXPECT_GT(p_value([&](auto& s) { return number(table, s, 1); }, cells), level);
    EXPECT_LT(p_value([&](auto& s) { return number(table, s, 1.3f); }, 360), level);
    // An inverse that keeps to the first of the bins of each element is seen.
    const auto first_bin = [&](auto& s) {
      const std::uint32_t i = table.sample(s.next()).index;
      const float bin = std::floor(table.invert<float>(i, 0.0f) * float(table.size()));
      for (;;) {
        const float u = (bin + s.next()) / float(table.size());
        if (table.sample(u).index == i) return u;
      }
    };
    EXPECT_LT(p_value(first_bin, 360), level);
  }
}

TEST(AliasTable, lanes_invert_as_floats_do) {
  const AliasTable table(weights);
  RandomStream<NativeFloats> stream(lane_index<NativeFloats>(), Uint<NativeFloats>(5u));
  for (int i = 0; i < 200; ++i) {
    const DiscreteSample<NativeFloats> s = table.sample(stream.next());
    const NativeFloats v = stream.next(), u = table.invert(s.index, v);
    for (int k = 0; k < native_lanes; ++k) EXPECT_EQ(lane(u, k), table.invert<float>(lane(s.index, k), lane(v, k)));
  }
}

TEST(Discrete, single_and_zero_weights_are_served_and_bad_weights_refused) {
  EXPECT_EQ(DiscreteCdf(std::vector<double>{5}).sample(0.99f).index, 0u);
  EXPECT_EQ(AliasTable(std::vector<double>{5}).sample(0.99f).index, 0u);
  EXPECT_EQ(DiscreteCdf(std::vector<double>{0, 0}).sample(0.6f).index, 1u);
  EXPECT_FLOAT_EQ(AliasTable(std::vector<double>{0, 0}).mass<float>(1u).value, 0.5f);
  EXPECT_THROW(DiscreteCdf(std::vector<double>{}), std::invalid_argument);
  EXPECT_THROW(AliasTable(std::vector<double>{1, -1}), std::invalid_argument);
  EXPECT_THROW(DiscreteCdf(std::vector<double>{1, NAN}), std::invalid_argument);
}

TEST(Discrete, an_element_of_weight_zero_is_never_chosen) {
  const DiscreteCdf cdf(weights);
  const AliasTable alias(weights);
  for (std::uint32_t i = 0; i < 1u << 20; ++i) {
    const float u = float(i) * 0x1p-20f;
    ASSERT_GT(weights[cdf.sample(u).index], 0);
    ASSERT_GT(weights[alias.sample(u).index], 0);
  }
  ASSERT_GT(weights[cdf.sample(one_minus_epsilon).index], 0);
  ASSERT_GT(weights[alias.sample(one_minus_epsilon).index], 0);
}

TEST(PiecewiseConstant1, samples_match_density) {
  const std::vector<double> table{1, 0, 4, 2, 2, 0.1, 7, 0, 0, 3};
  const PiecewiseConstant1 d(table);
  check_line([&](auto u) { return d.sample(u).x; }, [&](float x) { return d.density(x).value; },
             [&](float x) { return d.invert(x); }, 0, 1);
  double total = 0;
  for (double w : table) total += w;
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(d.density((float(i) + 0.5f) / 10).value, 10 * table[i] / total, 1e-5);
}

TEST(PiecewiseConstant2, samples_match_density) {
  const std::uint32_t width = 20, height = 10;
  std::vector<float> table;
  double total = 0;
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const bool empty_row = i / width == 4;
    table.push_back(empty_row ? 0.0f : std::max(0.0f, unit_float<float>(mix_bits(i)) * 8 - 1));
    total += double(table.back());
  }
  const PiecewiseConstant2 d(table, width, height);
  EXPECT_NEAR(d.mean(), total / (width * height), 1e-9 * total);
  // Rows of the table go along y: the chart's first coordinate is y.
  const auto chart = [](Vec2f p) { return SpherePoint{double(p.y), double(p.x)}; };
  const auto truth = [&](double y, double x) {
    return double(table[std::size_t(y * height) * width + std::size_t(x * width)]) / d.mean();
  };
  for (Grid grid : {coarse_grid, fine_grid}) {
    const TestResult r =
        chi_square_square([&](auto& s) { return chart(d.sample(s.next2()).p); }, truth, grid, samples, 1);
    EXPECT_GT(r.p_value, level) << r.note;
  }
  const auto faulty = [&](auto& s) {
    const Vec2f u = s.next2();
    return chart(d.sample(Vec2f{u.x, bent(u.y)}).p);
  };
  EXPECT_LT(chi_square_square(faulty, truth, coarse_grid, samples, 1).p_value, level);

  RandomStream<NativeFloats> stream(lane_index<NativeFloats>(), Uint<NativeFloats>(5u));
  for (int i = 0; i < 200; ++i) {
    const Vec2<NativeFloats> u = stream.next2();
    const auto many = d.sample(u);
    for (int k = 0; k < native_lanes; ++k) {
      const auto one = d.sample(lane(u, k));
      EXPECT_EQ(lane(many.p, k).x, one.p.x);
      EXPECT_EQ(lane(many.density.value, k), one.density.value);
      EXPECT_EQ(d.density(one.p).value, one.density.value);
      EXPECT_NEAR(one.density.value / truth(one.p.y, one.p.x), 1, 1e-3);
      const Vec2f back = d.invert(one.p);
      EXPECT_NEAR(back.x, lane(u.x, k), 1e-5);
      EXPECT_NEAR(back.y, lane(u.y, k), 1e-5);
    }
  }
}

// A tile by its mass, then a point of it, is a point of the table. Borders of the tiles divide its cells, or cells
// divide the tiles.
TEST(PiecewiseTiles, points_of_tiles_are_points_of_the_table_and_a_wrong_choice_of_tiles_is_found) {
  struct Size {
    std::uint32_t width, height;
  };
  constexpr std::uint32_t side = 4;
  for (const Size size : {Size{1, 1}, Size{3, 2}, Size{5, 10}, Size{16, 8}}) {
    SCOPED_TRACE(testing::Message() << size.width << " x " << size.height);
    std::vector<float> cells;
    for (std::uint32_t i = 0; i < size.width * size.height; ++i)
      cells.push_back(std::max(0.0f, unit_float<float>(mix_bits(i + 7)) * 5 - 1) + (i == 0 ? 30.0f : 0.0f));
    const auto table = std::make_shared<PiecewiseConstant2>(cells, size.width, size.height);
    const PiecewiseTiles tiles(table, side);
    ASSERT_EQ(tiles.masses().size(), side * side);
    double sum = 0;
    for (double mass : tiles.masses()) sum += mass;
    EXPECT_NEAR(sum, 1, 1e-5);

    const auto sample_by = [&](const AliasTable& choice) {
      return [&](auto& s) {
        const std::uint32_t tile = choice.sample(s.next()).index;
        const auto [p, density] = tiles.sample<float>(tile % side, tile / side, s.next2());
        EXPECT_EQ(density.value, table->density(p).value);
        EXPECT_EQ(std::uint32_t(p.x * side), tile % side);
        EXPECT_EQ(std::uint32_t(p.y * side), tile / side);
        return p;
      };
    };
    const auto truth = [&](double x, double y) {
      const auto at = std::size_t(y * size.height) * size.width + std::size_t(x * size.width);
      return double(cells[at]) / table->mean();
    };
    // Its cells are parts of those of the table.
    const Grid grid{int(size.width * side), int(size.height * side)};
    const TestResult r = chi_square_square(sample_by(AliasTable(tiles.masses())), truth, grid, samples, 1);
    EXPECT_GT(r.p_value, level) << r.note;
    std::vector<double> wrong = tiles.masses();
    wrong.front() *= 0.9;
    EXPECT_LT(chi_square_square(sample_by(AliasTable(wrong)), truth, grid, samples, 1).p_value, level);
  }
}

TEST(PiecewiseTiles, draw_the_same_in_every_lane_as_alone) {
  using F = NativeFloats;
  std::vector<float> cells;
  for (std::uint32_t i = 0; i < 21 * 13; ++i) cells.push_back(std::max(0.0f, unit_float<float>(mix_bits(i)) - 0.3f));
  const PiecewiseTiles tiles(std::make_shared<PiecewiseConstant2>(cells, 21u, 13u), 8);
  RandomStream<F> stream(lane_index<F>(), Uint<F>(9u));
  for (int i = 0; i < 500; ++i) {
    const Uint<F> column = to_uint(stream.next() * 8.0f), row = to_uint(stream.next() * 8.0f);
    const Vec2<F> u = stream.next2();
    const auto many = tiles.sample<F>(column, row, u);
    for (int k = 0; k < native_lanes; ++k) {
      const auto one = tiles.sample<float>(lane(column, k), lane(row, k), lane(u, k));
      EXPECT_EQ(lane(many.p, k).x, one.p.x);
      EXPECT_EQ(lane(many.p, k).y, one.p.y);
      EXPECT_EQ(lane(many.density.value, k), one.density.value);
    }
  }
}

}  // namespace
}  // namespace montelux
