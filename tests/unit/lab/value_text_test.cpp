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

}  // namespace
}  // namespace montelux::lab
