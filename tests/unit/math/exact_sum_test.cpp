// Sums that no order changes.
#include "math/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

// The sum over pairs of the products of their deviations from their means, in long arithmetic.
double co_moment_of(const std::vector<double>& a, const std::vector<double>& b) {
  long double mean_a = 0, mean_b = 0, sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) mean_a += a[i], mean_b += b[i];
  mean_a /= (long double)(a.size()), mean_b /= (long double)(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - mean_a) * (b[i] - mean_b);
  return double(sum);
}

struct Pairs {
  ExactSum a, b;
  ExactProducts squares, products;
  void add(double x, double y) {
    const ExactSum p(x), q(y);
    a += p, b += q, squares.add(p, p), products.add(p, q);
  }
  bool operator==(const Pairs&) const = default;
};

TEST(ExactProducts, have_the_co_moments_of_numbers_of_any_size_and_sign) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double size : {1e-6, 1.0, 1e4, 1e11})
    for (const double offset : {0.0, 1.0, -1000.0}) {
      std::vector<double> a, b;
      Pairs sums;
      for (int i = 0; i < 50; ++i) {
        a.push_back(size * (offset + unit(random))), b.push_back(size * (unit(random) - offset) + a.back());
        if (std::abs(a.back()) < 1e12) sums.add(a.back(), b.back());
      }
      if (std::abs(size * offset) > 1e11) continue;
      const double squares = co_moment_of(a, a), products = co_moment_of(a, b);
      EXPECT_NEAR(sums.squares.co_moment(50, sums.a, sums.a), squares, 1e-9 * squares) << size << " " << offset;
      EXPECT_NEAR(sums.products.co_moment(50, sums.a, sums.b), products, 1e-9 * squares) << size << " " << offset;
    }
}

TEST(ExactProducts, do_not_depend_on_the_order) {
  std::vector<float> numbers = wide_numbers(5);
  Pairs first, second;
  for (std::size_t i = 0; i + 1 < numbers.size(); ++i) first.add(numbers[i], numbers[i + 1]);
  for (std::size_t i = numbers.size() - 1; i-- > 0;) second.add(numbers[i], numbers[i + 1]);
  EXPECT_EQ(first, second);
}

TEST(ExactProducts, of_a_constant_have_no_deviation) {
  Pairs sums;
  for (int i = 0; i < 1000; ++i) sums.add(0.1, i % 7);
  EXPECT_EQ(sums.squares.co_moment(1000, sums.a, sums.a), 0);
  EXPECT_EQ(sums.products.co_moment(1000, sums.a, sums.b), 0);
}

TEST(ExactProducts, hold_as_many_of_the_largest_as_sums_do) {
  Pairs sums;
  const double largest = std::nextafter(double(ExactSum::largest), 0);
  sums.add(largest, -largest), sums.add(-largest, largest);
  ExactProducts squares = sums.squares, products = sums.products;
  for (int doubling = 0; doubling < 23; ++doubling) squares += squares, products += products;
  EXPECT_DOUBLE_EQ(squares.co_moment(1u << 24, {}, {}), 0x1p24 * 0x1p80);
  EXPECT_DOUBLE_EQ(products.co_moment(1u << 24, {}, {}), -0x1p24 * 0x1p80);
}

TEST(ExactProducts, are_what_their_words_say) {
  Pairs sums;
  sums.add(-3.25, 1e6), sums.add(7, 0.1);
  EXPECT_EQ(ExactProducts::of_words(sums.products.words()), sums.products);
  EXPECT_EQ(ExactSum::of_units(sums.a.units()), sums.a);
}

}  // namespace

}  // namespace montelux
