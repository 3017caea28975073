// Numbers as text, against the C library's own conversion.
#include "io/numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

namespace montelux {
namespace {

TEST(Numbers, of_few_digits_round_as_the_c_library_does) {
  std::mt19937 random(5);
  for (int i = 0; i < 200000; ++i) {
    std::string text = random() % 2 ? "-" : "";
    std::size_t digits = 1 + random() % 12, point = random() % (digits + 1);
    for (std::size_t k = 0; k < digits; ++k) {
      if (k == point) text += '.';
      text += static_cast<char>('0' + random() % 10);
    }
    if (random() % 4 == 0) text.append("e").append(std::to_string(static_cast<int>(random() % 45) - 30));
    auto value = to_float(text);
    ASSERT_TRUE(value) << text;
    ASSERT_EQ(*value, std::strtof(text.c_str(), nullptr)) << text;
  }
}
TEST(Numbers, may_have_a_sign_and_must_be_whole) {
  EXPECT_EQ(to_float("+1.5"), 1.5f);
  EXPECT_EQ(to_float(".5"), 0.5f);
  EXPECT_EQ(to_float("5."), 5.0f);
  EXPECT_TRUE(std::signbit(*to_float("-0")));
  EXPECT_EQ(to_float("1e-60"), 0.0f);
  for (const char* text : {"", "+", "-", ".", "-.", "1.2.3", "1e", "0x10", "1f", "--1", "+-1", "1e39", "inf", "nan"})
    EXPECT_FALSE(to_float(text)) << text;
}
TEST(Numbers, read_back_as_they_were_written) {
  std::mt19937 random(6);
  for (int i = 0; i < 100000; ++i) {
    float value =
        std::ldexp(static_cast<float>(random()) / 4294967296.0f - 0.5f, static_cast<int>(random() % 200) - 100);
    ASSERT_EQ(to_float(shortest(value)), value);
  }
}

}  // namespace
}  // namespace montelux
