#include "color/colorspace.h"

#include <gtest/gtest.h>

namespace montelux {
namespace {

void expect_matrix(const Matrix3& a, const double (&truth)[3][3], double tolerance) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(a.m[i][j], truth[i][j], tolerance) << i << ' ' << j;
}

TEST(ColorSpace, matrices_to_xyz_are_the_published_ones) {
  // IEC 61966-2-1, ITU-R BT.2020, SMPTE EG 432-1 with the white D65, and SMPTE ST 2065-1, to seven places.
  expect_matrix(
      to_xyz(*color_space("srgb")),
      {{0.4123908, 0.3575843, 0.1804808}, {0.2126390, 0.7151687, 0.0721923}, {0.0193308, 0.1191948, 0.9505322}}, 1e-7);
  expect_matrix(to_xyz(*color_space("rec2020")),
                {{0.6369580, 0.1446169, 0.1688810}, {0.2627002, 0.6779981, 0.0593017}, {0.0, 0.0280727, 1.0609851}},
                1e-7);
  expect_matrix(to_xyz(*color_space("dci-p3")),
                {{0.4865709, 0.2656677, 0.1982173}, {0.2289746, 0.6917385, 0.0792869}, {0.0, 0.0451134, 1.0439444}},
                1e-7);
  expect_matrix(to_xyz(*color_space("aces2065-1")),
                {{0.9525524, 0.0, 0.0000937}, {0.3439664, 0.7281661, -0.0721325}, {0.0, 0.0, 1.0088252}}, 1e-7);
}

TEST(ColorSpace, reflectances_of_aces_are_adapted_and_its_lights_are_not) {
  ColorSpace aces = *color_space("aces2065-1");
  // The matrix of the ACES system from AP0 to Rec. 709 with the Bradford transform.
  expect_matrix(reflectance_to_srgb(aces),
                {{2.5217, -1.1341, -0.3876}, {-0.2765, 1.3727, -0.0962}, {-0.0154, -0.1530, 1.1684}}, 2e-4);
  Rgb white = reflectance_to_srgb(aces) * gray_rgb(1.0f);
  for (float c : white.c) EXPECT_NEAR(c, 1.0f, 1e-6f);
  Rgb light = emission_to_srgb(aces) * gray_rgb(1.0f);
  EXPECT_GT(light.c[0], light.c[2] * 1.05f);
  EXPECT_NEAR(luminance(light), 1.0f, 1e-5f);
}

TEST(ColorSpace, srgb_is_itself_and_names_are_known) {
  Rgb color{0.2f, 0.5f, 0.9f};
  for (const Matrix3& m : {emission_to_srgb(*color_space("srgb")), reflectance_to_srgb(*color_space("srgb"))}) {
    Rgb same = m * color;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(same.c[i], color.c[i], 1e-6f);
  }
  Rgb back = to_srgb(to_xyz(color));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(back.c[i], color.c[i], 1e-6f);
  EXPECT_NEAR(to_xyz(color).y, double(luminance(color)), 1e-6);
  EXPECT_EQ(color_spaces().size(), 4u);
  EXPECT_FALSE(color_space("adobe"));
}

}  // namespace
}  // namespace montelux
