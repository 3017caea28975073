// The tail index of terms, and recursive stratification.
#include "mc/tail.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mc/miser.h"
#include "statistics.h"

namespace montelux {
namespace {

TEST(LargestTerms, keeps_the_largest_whatever_the_order_and_the_parts) {
  LargestTerms all, a, b;
  std::vector<double> terms;
  for (int i = 0; i < 1000; ++i) terms.push_back((i * 7919) % 1000 - 500);
  all.add(terms);
  a.add(std::span(terms).first(300));
  b.add(std::span(terms).subspan(300));
  a.merge(b);
  EXPECT_EQ(all.sorted(), a.sorted());
  EXPECT_EQ(all.sorted().front(), 500);
  EXPECT_EQ(all.sorted().size(), LargestTerms::of_part);
}

TEST(HillIndex, is_the_exponent_of_a_power_law) {
  for (double index : {0.5, 1.0, 2.0, 5.0}) {
    std::vector<double> largest;
    for (int i = 1; i <= 100; ++i) largest.push_back(std::pow((i - 0.5) / 1e6, -1 / index));
    // Hill's sum of logarithms over these quantiles, in closed form: 1.5 % more than the exponent itself.
    const double logarithms = 100 * std::log(99.5) - (std::lgamma(100.5) - std::lgamma(0.5));
    EXPECT_NEAR(hill_index(largest) / index, 99 / logarithms, 1e-12) << index;
  }
}

TEST(HillIndex, is_large_where_the_terms_are_bounded) {
  std::vector<double> largest;
  for (int i = 0; i < 100; ++i) largest.push_back(1 - i * 1e-5);
  EXPECT_GT(hill_index(largest), 100);
  EXPECT_TRUE(std::isinf(hill_index(std::vector<double>(100, 1.0))));
}

// exp(-50 |x - 0.2|^2) in the plane: a peak away from the centre.
void peak(std::span<const double> points, std::span<double> values) {
  const std::size_t n = values.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double x = points[i] - 0.2, y = points[n + i] - 0.2;
    values[i] = std::exp(-50 * (x * x + y * y));
  }
}

TEST(Miser, is_unbiased_and_better_than_plain_sampling) {
  const double side =
      std::sqrt(std::numbers::pi / 50) / 2 * (std::erf(0.8 * std::sqrt(50)) + std::erf(0.2 * std::sqrt(50)));
  std::vector<double> means;
  double claimed = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const RegionEstimate e = miser(peak, 2, 20000, CubeKey::of(i, 1));
    means.push_back(e.mean), claimed += e.variance / 200;
  }
  const test::SampleSummary s = test::summarize(means);
  EXPECT_GT(test::t_test(s, side * side).p_value, 1e-3);
  EXPECT_LT(test::t_test(s, 1.003 * side * side).p_value, 1e-3);
  // The variance of one uniform sample is the integral of the square, pi / 100 of the plane, less the square.
  const double plain = (std::numbers::pi / 100 - side * side * side * side) / 20000;
  EXPECT_LT(s.variance, 0.2 * plain);
  // What it claims is the variance that there is; three quarters of it, or four thirds, are not.
  constexpr double many = 1e6;
  EXPECT_GT(test::f_test_p_value(s.variance, s.count, claimed, many), 1e-3);
  EXPECT_GT(test::f_test_p_value(claimed, many, s.variance, s.count), 1e-3);
  EXPECT_LT(test::f_test_p_value(s.variance, s.count, 0.6 * claimed, many), 1e-3);
  EXPECT_LT(test::f_test_p_value(1.7 * claimed, many, s.variance, s.count), 1e-3);
}

}  // namespace
}  // namespace montelux
