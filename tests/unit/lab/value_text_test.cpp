// Values with errors as people write them.
#include "lab/statement/value_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace montelux::lab {
namespace {

TEST(ValueText, the_error_has_two_digits_and_the_value_as_many_places) {
  EXPECT_EQ(value_with_error(1.00003, 0.00021), "1.00003(21)");
  EXPECT_EQ(value_with_error(0.99994, 0.00037), "0.99994(37)");
  EXPECT_EQ(value_with_error(-3.14159, 0.0123), "-3.142(12)");
  EXPECT_EQ(value_with_error(0.5, 0.0999), "0.50(10)");
  EXPECT_EQ(value_with_error(0.5, 0.00996), "0.500(10)");
  EXPECT_EQ(value_with_error(12.34, 2.06), "12.3(2.1)");
  EXPECT_EQ(value_with_error(1234.4, 21.3), "1234(21)");
  EXPECT_EQ(value_with_error(12.34, 0.999), "12.3(1.0)");
}

TEST(ValueText, very_small_and_very_large_values_have_an_exponent) {
  EXPECT_EQ(value_with_error(1.2345e-9, 5.6e-12), "1.2345(56)e-09");
  EXPECT_EQ(value_with_error(1.2345e12, 5.6e9), "1.2345(56)e+12");
  EXPECT_EQ(value_with_error(123456, 1234), "1.235(12)e+05");
  EXPECT_EQ(value_with_error(0, 3.4e-7), "0.0(3.4)e-07");
}

TEST(ValueText, errors_that_are_none_are_said) {
  EXPECT_EQ(value_with_error(0.25, 0), "0.25(0)");
  EXPECT_EQ(value_with_error(0.25, std::nan("")), "0.25(?)");
  EXPECT_EQ(value_with_error(0.25, INFINITY), "0.25(?)");
  EXPECT_EQ(value_with_error(NAN, 1), "nan");
}

TEST(ValueText, an_error_of_rounding_shows_the_digits_that_a_double_has) {
  EXPECT_EQ(value_with_error(3, 2.7e-15), "3.000000000000000(3)");
  EXPECT_EQ(value_with_error(2, 1e-17), "2.000000000000000(1)");
  EXPECT_EQ(value_with_error(0.1, 8.9e-17), "0.1000000000000000(1)");
  EXPECT_EQ(value_with_error(3e-16, 2.7e-31), "3.000000000000000(3)e-16");
}

TEST(ValueText, plus_minus_rounds_both_to_the_second_digit_of_the_error) {
  EXPECT_EQ(value_plus_minus(541.1, 100), "540 ± 100");
  EXPECT_EQ(value_plus_minus(541.1, 99.7), "540 ± 100");
  EXPECT_EQ(value_plus_minus(0.123456, 0.00213), "0.1235 ± 0.0021");
  EXPECT_EQ(value_plus_minus(-1.0049, 0.0251), "-1.005 ± 0.025");
  EXPECT_EQ(value_plus_minus(12345, 2000), "12300 ± 2000");
  EXPECT_EQ(value_plus_minus(3, 12), "3 ± 12");
  EXPECT_EQ(value_plus_minus(0.01, 2), "0.0 ± 2.0");
  EXPECT_EQ(value_plus_minus(541.1, 1), "541.1 ± 1.0");
}

TEST(ValueText, plus_minus_of_very_small_and_very_large_values_has_one_exponent) {
  EXPECT_EQ(value_plus_minus(5.41e-5, 1e-6), "(5.41 ± 0.10)e-05");
  EXPECT_EQ(value_plus_minus(2.5e9, 3e7), "(2.500 ± 0.030)e+09");
  EXPECT_EQ(value_plus_minus(1e-7, 3e-4), "(0.0 ± 3.0)e-04");
}

TEST(ValueText, plus_minus_says_what_is_not_known) {
  EXPECT_EQ(value_plus_minus(NAN, 1), "not known");
  EXPECT_EQ(value_plus_minus(INFINITY, NAN), "not known");
  EXPECT_EQ(value_plus_minus(541.1, INFINITY), "541.1 (error not known)");
  EXPECT_EQ(value_plus_minus(541.1, NAN), "541.1 (error not known)");
  EXPECT_EQ(value_plus_minus(2, 0), "2 ± 0");
}

TEST(ValueText, intervals_have_the_places_of_their_nearer_bound) {
  EXPECT_EQ(value_in_interval(2.3123, 2.1019, 2.5512), "2.31 (2.10 to 2.55)");
  EXPECT_EQ(value_in_interval(1.5, 1.0, 300.0), "1.50 (1.00 to 300.00)");
  EXPECT_EQ(value_in_interval(541.1, 441.1, 661.1), "540 (440 to 660)");
  EXPECT_EQ(value_in_interval(4.2e-5, 4.0e-5, 4.5e-5), "4.20e-05 (4.00 to 4.50)");
  EXPECT_EQ(value_in_interval(2, 0, INFINITY), "2.0 (0.0 to any more)");
  EXPECT_EQ(value_in_interval(NAN, 0, INFINITY), "not known");
}

}  // namespace
}  // namespace montelux::lab
