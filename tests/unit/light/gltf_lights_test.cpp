// What lights take beyond pbrt's parameters: the squared edge of a spot, images by longitude and latitude, and
// triangles that are chosen by what their part of an image sends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/builder.h"
#include "light/point.h"

namespace montelux {
namespace {

TEST(SpotEdge, may_be_the_square_of_a_ramp_of_the_cosine) {
  const float low = std::cos(0.8f), high = std::cos(0.3f);
  for (float x : {0.5f, low, 0.75f, 0.9f, high, 1.0f}) {
    const double t = std::clamp(double(x - low) / double(high - low), 0.0, 1.0);
    EXPECT_NEAR(soft_step(x, low, high, 0.0f), t * t, 1e-6);
    EXPECT_NEAR(soft_step(x, low, high, 2.0f), t * t * (3 - 2 * t), 1e-6);
  }
}

TEST(SpotEdge, keeps_its_share_of_the_sphere) {
  // The integral of the edge over the sphere, by midpoints over the cosine.
  for (const bool squared : {false, true}) {
    const SpotCone cone{50, 20, squared};
    const float low = std::cos(50 * pi / 180), high = std::cos(20 * pi / 180);
    double sum = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i)
      sum += double(soft_step(float((i + 0.5) / n), low, high, squared ? 0.0f : 2.0f)) / n * 2 * std::numbers::pi;
    EXPECT_NEAR(solid_angle(cone), sum, 1e-4);
  }
}

// An image with a bright square of texels; the light from its middle, and nothing from elsewhere.
TEST(LatitudeImage, shines_from_where_it_has_its_light) {
  auto image = std::make_shared<LightImage>();
  image->width = 64, image->height = 32;
  image->texels.assign(64 * 32, gray_rgb(0.0f));
  // Azimuth (20.5 / 64) of a turn from +x toward +y, polar angle (9.5 / 32) of half a turn from +z.
  for (int y = 7; y <= 11; ++y)
    for (int x = 18; x <= 22; ++x) image->texels[std::size_t(y * 64 + x)] = gray_rgb(100.0f);
  InfiniteLightDesc sky;
  sky.file = "sky", sky.mapping = EnvironmentMapping::latlong;
  LightDesc light;
  light.model = sky;
  const LightInputs inputs{[](const SpectrumValue&) { return gray_rgb(1.0f); },
                           [&](const std::string&, const SourceLocation&) { return image; }};
  LightSetBuilder builder;
  Diagnostics diagnostics;
  ASSERT_TRUE(builder.add(light, inputs, diagnostics));
  const LightSet lights = std::move(builder).build({}, {0, 0, 0}, 1);
  const double azimuth = 20.5 / 64 * 2 * std::numbers::pi, polar = 9.5 / 32 * std::numbers::pi;
  const Vec3f w{float(std::sin(polar) * std::cos(azimuth)), float(std::sin(polar) * std::sin(azimuth)),
                float(std::cos(polar))};
  const auto radiance = [&](Vec3f d) { return lights.escaped<float>(0, {0, 0, 0}, {0, 0, 0}, d, true).radiance[0]; };
  EXPECT_NEAR(radiance(w), 100, 1);
  EXPECT_EQ(radiance(-w), 0);
  // All of the light is there still.
  double whole = 0, expected = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double z = 1 - 2 * (i + 0.5) / n, r = std::sqrt(1 - z * z), phi = (j + 0.5) / n * 2 * std::numbers::pi;
      whole += double(radiance({float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)})) / (double(n) * n);
    }
  expected = 100 * 5.0 / 64 * 0.5 * (std::cos(7 * std::numbers::pi / 32) - std::cos(12 * std::numbers::pi / 32));
  EXPECT_NEAR(whole, expected, 0.02 * expected);
  EXPECT_EQ(radiance({w.x, -w.y, w.z}), 0);
}

// A triangle over one part of an image that is black except one texel: how often it is chosen beside a triangle that
// shines everywhere.
double share_of_triangle(Vec2f low, Vec2f high, int bright_x, int bright_y) {
  auto image = std::make_shared<LightImage>();
  image->width = image->height = 256;
  image->texels.assign(256 * 256, gray_rgb(0.0f));
  image->texels[std::size_t(bright_y) * 256 + std::size_t(bright_x)] = gray_rgb(1000.0f);
  Emission emission;
  emission.image = image, emission.local_power = true;
  LightSetBuilder builder;
  const TriangleShape triangle{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, low, {high.x, low.y}, high};
  const LightId mapped = builder.add(triangle, emission);
  builder.add(triangle, Emission{gray_rgb(1.0f)});
  LightSettings settings;
  settings.selection = LightSelection::power;
  const LightSet lights = LightSet(std::move(builder).build({}, {0, 0, 0}, 1)).with(settings);
  return lights.choice_mass<float>(std::uint32_t(mapped), {0, 0, 1}, {0, 0, 0}, true).value;
}

TEST(LocalPower, is_of_the_texels_that_a_triangle_shows) {
  // v upward: row 250 of the image is at the foot.
  EXPECT_GT(share_of_triangle({0, 0}, {0.1f, 0.1f}, 5, 250), 0.5);
  EXPECT_EQ(share_of_triangle({0, 0}, {0.1f, 0.1f}, 200, 20), 0);
}

TEST(LocalPower, is_zero_only_where_all_is_black) {
  // Between the texels that are looked at in a large part.
  EXPECT_GT(share_of_triangle({0, 0}, {1, 1}, 101, 103), 0);
  // Beside the triangle, no further than a look-up reaches.
  EXPECT_GT(share_of_triangle({0.5f, 0}, {0.6f, 0.1f}, 127, 250), 0);
  // Beyond the edge an image is as at the edge.
  EXPECT_GT(share_of_triangle({1.5f, 0}, {2.5f, 0.01f}, 255, 255), 0);
}

}  // namespace
}  // namespace montelux
