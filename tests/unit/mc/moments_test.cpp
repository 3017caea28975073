#include "mc/moments.h"

#include <gtest/gtest.h>

#include <limits>

#include "mc/random.h"

namespace montelux {
namespace {

TEST(Moments, are_those_of_a_small_set_by_hand) {
  Moments m;
  for (double x : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) m.add(x);
  EXPECT_DOUBLE_EQ(m.mean, 5);
  EXPECT_DOUBLE_EQ(m.variance(), 32.0 / 7);
  EXPECT_DOUBLE_EQ(m.standard_error(), std::sqrt(32.0 / 7 / 8));
}

TEST(Moments, keep_the_variance_of_values_far_from_zero) {
  Moments m;
  for (int i = 0; i < 1000; ++i) m.add(1e9 + i % 2);
  EXPECT_NEAR(m.variance(), 0.25 * 1000 / 999, 1e-9);
}

TEST(Moments, merging_equals_one_long_stream) {
  RandomStream<float> stream(1, 2);
  Moments whole, parts[3], merged;
  for (int i = 0; i < 3000; ++i) {
    const double x = double(stream.next());
    whole.add(x);
    parts[i % 7 == 0 ? 0 : 1 + i % 2].add(x);
  }
  merged.merge(Moments{});
  for (const Moments& part : parts) merged.merge(part);
  EXPECT_EQ(merged.count, whole.count);
  EXPECT_NEAR(merged.mean, whole.mean, 1e-13);
  EXPECT_NEAR(merged.m2, whole.m2, 1e-9);
}

TEST(Moments, count_non_finite_values_and_leave_them_out) {
  Moments m;
  for (double x : {1.0, std::numeric_limits<double>::quiet_NaN(), 3.0, std::numeric_limits<double>::infinity()})
    m.add(x);
  EXPECT_EQ(m.estimate().count, 2u);
  EXPECT_EQ(m.estimate().non_finite, 2u);
  EXPECT_DOUBLE_EQ(m.estimate().mean, 2);
}

}  // namespace
}  // namespace montelux
