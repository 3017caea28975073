#include <gtest/gtest.h>

#include <cmath>

#include "lab/compare/statistics.h"

namespace montelux::lab {
namespace {

TEST(Measured, has_the_interval_of_student) {
  // Three values 1, 2, 3: standard error 1 / sqrt 3, and t_0.975 with two degrees of freedom is 4.302653.
  const Measured m = measured({1, 2, 3}, 0.95);
  EXPECT_DOUBLE_EQ(m.mean, 2);
  EXPECT_NEAR(m.high - m.mean, 4.302653 / std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(m.mean - m.low, 4.302653 / std::sqrt(3.0), 1e-6);
}

TEST(Measured, says_nothing_from_one_value) {
  const Measured m = measured({2}, 0.95);
  EXPECT_EQ(m.mean, 2);
  EXPECT_EQ(m.high, INFINITY);
}

TEST(Measured, leaves_out_what_is_not_finite) {
  const Measured m = measured({1, NAN, 3, INFINITY, 2}, 0.95), none = measured({NAN, NAN}, 0.95);
  EXPECT_EQ(m.count, 3);
  EXPECT_DOUBLE_EQ(m.mean, 2);
  EXPECT_EQ(none.count, 0);
}

TEST(Measured, is_written_with_what_is_known_of_it) {
  EXPECT_EQ(text_of(measured({1, 2, 3}, 0.95)), "2.0 ± 2.5");
  EXPECT_EQ(text_of(measured({2}, 0.95)), "2 (one repeat)");
  EXPECT_EQ(text_of(measured({NAN, NAN}, 0.95)), "not known");
  EXPECT_EQ(text_of(Measured{}), "not known");
}

TEST(MeasuredRatio, pairs_the_values) {
  const Measured m = measured_ratio({2, 20, 200}, {1, 10, 100}, 0.95);
  EXPECT_NEAR(m.mean, 2, 1e-12);
  EXPECT_NEAR(m.high, 2, 1e-9);
  EXPECT_NEAR(measured_ratio({1, 4}, {1, 1}, 0.95).mean, 2, 1e-12);
}

TEST(MeasuredRatio, leaves_out_what_has_no_logarithm) {
  EXPECT_EQ(measured_ratio({-1, 2, 3}, {1, 1, 1}, 0.95).count, 2);
  EXPECT_TRUE(std::isnan(measured_ratio({}, {}, 0.95).mean));
}

TEST(LogSlope, is_the_exponent_of_a_power_law) {
  EXPECT_NEAR(log_slope({1, 2, 4, 8}, {3, 3.0 / 4, 3.0 / 16, 3.0 / 64}), -2, 1e-12);
}

}  // namespace
}  // namespace montelux::lab
