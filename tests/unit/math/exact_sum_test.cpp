// Sums that no order changes.
#include "math/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace montelux {

namespace {

// Numbers of either sign from 1e-9 to 1e9, in a shuffled order.
std::vector<float> wide_numbers(std::uint32_t seed) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> exponent(-30, 30);
  std::vector<float> x;
  for (int i = 0; i < 1000; ++i) x.push_back(std::exp2(exponent(random)) * (i % 3 == 0 ? -1.0f : 1.0f));
  std::mt19937 order(seed);
  std::shuffle(x.begin(), x.end(), order);
  return x;
}

TEST(ExactSum, does_not_depend_on_the_order_as_a_sum_of_doubles_does) {
  ExactSum first, second;
  double plain_first = 0, plain_second = 0;
  for (float x : wide_numbers(1)) first.add(x), plain_first += double(x);
  for (float x : wide_numbers(2)) second.add(x), plain_second += double(x);
  EXPECT_EQ(first, second);
  EXPECT_NE(plain_first, plain_second);
}

TEST(ExactSum, of_parts_is_the_sum_of_the_whole) {
  ExactSum whole, parts[3], sum;
  const std::vector<float> numbers = wide_numbers(3);
  for (std::size_t i = 0; i < numbers.size(); ++i) whole.add(numbers[i]), parts[i % 3].add(numbers[i]);
  for (const ExactSum& part : parts) sum += part;
  EXPECT_EQ(sum, whole);
  sum -= parts[1];
  EXPECT_FALSE(sum == whole);
}

TEST(ExactSum, holds_floats_of_ordinary_size_exactly) {
  for (float x : wide_numbers(4)) {
    ExactSum one;
    one.add(x);
    EXPECT_EQ(one.value(), double(x));
  }
  ExactSum small;
  small.add(1e-30f);
  EXPECT_EQ(small.value(), 0);
}

TEST(ExactSum, holds_as_many_of_the_largest_as_it_says) {
  ExactSum sum;
  sum.add(ExactSum::largest);
  for (int doubling = 0; doubling < 24; ++doubling) sum += ExactSum(sum);
  EXPECT_EQ(sum.value(), 0x1p64);
}

}  // namespace

}  // namespace montelux
