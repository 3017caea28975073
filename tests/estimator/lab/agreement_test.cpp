// Does a method agree with the reference? The level, the power, and what too few repeats cannot tell.
#include "lab/compare/agreement.h"

#include <gtest/gtest.h>

#include "mc/random.h"
#include "statistics.h"

namespace montelux::lab {
namespace {

using namespace montelux::test;
using Outcome = Agreement::Outcome;

constexpr double sigma = 0.3, reference_error = 0.05;

// Standard normal.
double normal(RandomStream<float>& random) {
  return normal_quantile(std::clamp(double(random.next()), 1e-7, 1 - 1e-7));
}

// A method of `passes` normal pass means that are off by `bias` in one channel, and a reference with an error of its
// own.
Agreement comparison(RandomStream<float>& random, int passes, double bias, double level) {
  std::array<MeanDifference, 3> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    Moments means;
    for (int p = 0; p < passes; ++p) means.add((c == 1 ? bias : 0) + sigma * normal(random));
    channels[c] = {means.mean - reference_error * normal(random), means.variance() / passes, passes - 1.0,
                   reference_error * reference_error, INFINITY};
  }
  return judge_agreement(channels, {}, passes, level);
}

double share_of(Outcome outcome, int trials, int passes, double bias, double level) {
  RandomStream<float> random(7u, std::uint32_t(passes));
  int count = 0;
  for (int i = 0; i < trials; ++i) count += comparison(random, passes, bias, level).outcome == outcome;
  return double(count) / trials;
}

TEST(Agreement, keeps_its_level_for_few_repeats_and_many) {
  constexpr int trials = 8000;
  for (int passes : {3, 4, 8, 32}) {
    // Three independent tests at 1 % each. The tests are conservative where the reference's error counts: never more.
    const double false_alarms = share_of(Outcome::differs, trials, passes, 0, 0.01);
    EXPECT_LT((false_alarms - 0.0297) / std::sqrt(0.0297 / trials), normal_quantile(1 - family_level / 4)) << passes;
    // And not idle: the planted fault is a level that is taken for three times what it is.
    if (passes >= 8) {
      EXPECT_GT(share_of(Outcome::differs, trials, passes, 0, 0.03), 0.0297 + 4 * std::sqrt(0.0297 / trials)) << passes;
    }
  }
}

TEST(Agreement, finds_the_bias_that_it_says_it_would_find) {
  constexpr int trials = 4000;
  RandomStream<float> random(9u, 3u);
  const double level = 0.01;
  // The bias that is found nine times in ten, for the true standard error.
  const int passes = 16;
  const double error = std::sqrt(sigma * sigma / passes + reference_error * reference_error);
  const double stated = comparison(random, passes, 0, level).detectable;
  EXPECT_GT(stated, 3 * error);
  EXPECT_LT(stated, 8 * error);
  double mean_stated = 0;
  for (int i = 0; i < trials; ++i) mean_stated += comparison(random, passes, 0, level).detectable / trials;
  const double found = share_of(Outcome::differs, trials, passes, mean_stated, level);
  // The largest of the three stated ones is stated, so the power is at least that.
  EXPECT_LT(at_least_p_value(0.9, std::sqrt(0.09 / trials), found), 1) << found;
  EXPECT_GT(found, 0.9 - 3.3 * std::sqrt(0.09 / trials));
  // A planted fault: half of that bias is not found so often.
  EXPECT_LT(share_of(Outcome::differs, trials, passes, 0.5 * mean_stated, level), 0.6);
}

MeanDifference off_by(double standard_errors, double degrees) { return {standard_errors, 1, degrees, 0, INFINITY}; }

TEST(Agreement, never_calls_a_distance_beyond_chance_agreement) {
  // With one degree of freedom Student's distribution allows 362 standard errors; that is no agreement.
  for (double t : {8.1, 20.0, 362.0, 5000.0})
    for (double degrees : {1.0, 2.0, 4.0, 7.0, 1000.0})
      for (double sign : {-1.0, 1.0}) {
        const Agreement a = judge_agreement({off_by(sign * t, degrees), {}, {}}, {}, int(degrees) + 1, 0.00125);
        EXPECT_NE(a.outcome, Outcome::agrees) << sign * t << " " << degrees;
        EXPECT_DOUBLE_EQ(a.t, sign * t);
      }
  EXPECT_EQ(judge_agreement({off_by(-362, 1), {}, {}}, {}, 2, 0.00125).outcome, Outcome::too_few_repeats);
  EXPECT_EQ(judge_agreement({off_by(-8.1, 3), {}, {}}, {}, 4, 0.00125).outcome, Outcome::too_few_repeats);
  EXPECT_EQ(judge_agreement({off_by(-8.1, 60), {}, {}}, {}, 4, 0.00125).outcome, Outcome::differs);
  EXPECT_EQ(judge_agreement({off_by(1, 60), {}, {}}, {}, 4, 0.00125).outcome, Outcome::agrees);
  // Five degrees of freedom have a quantile of more than twice the normal one, six do not.
  EXPECT_EQ(judge_agreement({off_by(1, 5), {}, {}}, {}, 6, 0.00125).outcome, Outcome::too_few_repeats);
  EXPECT_EQ(judge_agreement({off_by(1, 7), {}, {}}, {}, 8, 0.00125).outcome, Outcome::agrees);
  // Fewer than three repeats tell nothing of single pixels.
  EXPECT_EQ(judge_agreement({off_by(1, 60), {}, {}}, {}, 2, 0.00125).outcome, Outcome::too_few_repeats);
}

TEST(Agreement, of_what_has_no_variance_is_equality) {
  const MeanDifference same{0, 0, 5, 0, INFINITY}, other{1e-9, 0, 5, 0, INFINITY};
  EXPECT_EQ(judge_agreement({same, same, same}, {}, 6, 0.01).outcome, Outcome::agrees);
  EXPECT_EQ(judge_agreement({same, other, same}, {}, 6, 0.01).outcome, Outcome::differs);
}

TEST(Agreement, takes_the_squared_bias_of_pixels_into_account) {
  const MeanDifference same{0, 1, 60, 0, INFINITY};
  const auto squared = [](double mean, int count) { return Measured{mean, 0, 0, 1, count}; };
  EXPECT_EQ(judge_agreement({same, same, same}, squared(12, 8), 8, 0.00125).outcome, Outcome::differs);
  EXPECT_EQ(judge_agreement({same, same, same}, squared(12, 3), 3, 0.00125).outcome, Outcome::too_few_repeats);
  // A square below zero is chance.
  EXPECT_EQ(judge_agreement({same, same, same}, squared(-12, 8), 8, 0.00125).outcome, Outcome::agrees);
}

TEST(Agreement, shares_one_level_over_all_tests_of_all_methods) {
  EXPECT_DOUBLE_EQ(level_of_each_test(0.01, 2), 0.01 / 8);
  EXPECT_DOUBLE_EQ(level_of_each_test(0.01, 6), 0.01 / 24);
}

}  // namespace
}  // namespace montelux::lab
