#include "color/transfer.h"

#include <gtest/gtest.h>

namespace montelux {
namespace {

TEST(Transfer, srgb_matches_the_standard_and_inverts) {
  EXPECT_EQ(srgb_encode(0.0f), 0.0f);
  EXPECT_NEAR(srgb_encode(1.0f), 1.0f, 1e-6f);
  EXPECT_NEAR(srgb_encode(0.18f), 0.46135612f, 1e-6f);
  EXPECT_NEAR(srgb_decode(0.5f), 0.21404114f, 1e-6f);
  for (int i = 0; i <= 255; ++i) {
    float encoded = float(i) / 255.0f;
    EXPECT_NEAR(srgb_encode(srgb_decode(encoded)), encoded, 1e-6f);
  }
}

TEST(Transfer, encodings_are_read_and_written_by_name) {
  for (const char* name : {"linear", "sRGB", "gamma 2.2"}) {
    std::optional<ColorEncoding> encoding = parse_encoding(name);
    ASSERT_TRUE(encoding) << name;
    EXPECT_EQ(to_string(*encoding), name);
    EXPECT_NEAR(decode(*encoding, encode(*encoding, 0.3f)), 0.3f, 1e-6f);
  }
  EXPECT_TRUE(parse_encoding("SRGB"));
  for (const char* name : {"", "gamma", "gamma x", "gamma -1", "gamma 2.2 3", "rec709"})
    EXPECT_FALSE(parse_encoding(name)) << name;
}

}  // namespace
}  // namespace montelux
