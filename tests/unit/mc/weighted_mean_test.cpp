// The mean of values with weights, against figures by hand.
#include "mc/weighted_mean.h"

#include <gtest/gtest.h>

#include <vector>

namespace montelux::test {
namespace {

WeightedMean mean_of(const std::vector<double>& weights, const std::vector<double>& values) {
  return weighted_mean(
      values.size(), [&](std::size_t i) { return weights[i]; }, [&](std::size_t i) { return values[i]; });
}

TEST(WeightedMean, of_equal_weights_is_that_of_student) {
  const WeightedMean m = mean_of({1, 1, 1}, {1, 2, 4});
  EXPECT_DOUBLE_EQ(m.mean, 7.0 / 3);
  EXPECT_DOUBLE_EQ(m.standard_error, std::sqrt(7.0) / 3);
  EXPECT_DOUBLE_EQ(m.degrees, 2);
}

TEST(WeightedMean, depends_on_shares_alone) {
  const WeightedMean a = mean_of({1, 2, 5}, {1, 2, 4}), b = mean_of({0.25, 0.5, 1.25, 0}, {1, 2, 4, 1000});
  EXPECT_DOUBLE_EQ(a.mean, 25.0 / 8);
  // Shares 1/8, 2/8 and 5/8, whose squares sum to 30/64.
  EXPECT_DOUBLE_EQ(a.degrees, 64.0 / 30 - 1);
  const double squares = (1 * 17 * 17 + 4 * 9 * 9 + 25 * 7 * 7) / 4096.0;
  EXPECT_DOUBLE_EQ(a.standard_error, std::sqrt(squares / (30.0 / 64) / a.degrees));
  EXPECT_DOUBLE_EQ(a.mean, b.mean);
  EXPECT_DOUBLE_EQ(a.standard_error, b.standard_error);
  EXPECT_DOUBLE_EQ(a.degrees, b.degrees);
}

TEST(WeightedMean, of_less_than_two_values_has_no_degrees_of_freedom) {
  EXPECT_EQ(mean_of({}, {}).degrees, 0);
  EXPECT_EQ(mean_of({0, 3}, {9, 5}).degrees, 0);
  EXPECT_EQ(mean_of({0, 3}, {9, 5}).mean, 5);
}

}  // namespace
}  // namespace montelux::test
