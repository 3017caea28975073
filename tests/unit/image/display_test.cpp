#include "image/display.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "color/transfer.h"

namespace montelux::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

PixelBuffer row_of(std::vector<std::string> channels, std::vector<float> values) {
  const int width = int(values.size() / channels.size());
  PixelBuffer image = make_pixel_buffer(width, 1, std::move(channels));
  image.values = std::move(values);
  return image;
}

// CIE L* of a linear colour.
float lightness(const Rgb& color) {
  const float y = luminance(color);
  return y > 216.0f / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

TEST(ColorMaps, grow_lighter_all_the_way_and_evenly_by_eighths) {
  for (ColorMap map : {ColorMap::viridis, ColorMap::magma}) {
    float before = lightness(color_at(map, 0));
    for (int i = 1; i <= 64; ++i) {
      const float here = lightness(color_at(map, float(i) / 64));
      EXPECT_GT(here, before) << i;
      before = here;
    }
    // They are even in the lightness of CAM02-UCS, and so in that of CIELAB within a third.
    const float eighth = (lightness(color_at(map, 1)) - lightness(color_at(map, 0))) / 8;
    for (int i = 0; i < 8; ++i) {
      const float step = lightness(color_at(map, float(i + 1) / 8)) - lightness(color_at(map, float(i) / 8));
      EXPECT_NEAR(step, eighth, eighth / 3) << i;
    }
  }
}

TEST(ColorMaps, have_their_published_ends) {
  const auto byte = [](float x) { return int(std::lround(255 * srgb_encode(x))); };
  const Rgb low = color_at(ColorMap::viridis, -1), high = color_at(ColorMap::viridis, 2);
  EXPECT_EQ(byte(low.c[0]), 0x44);
  EXPECT_EQ(byte(low.c[1]), 0x01);
  EXPECT_EQ(byte(low.c[2]), 0x54);
  EXPECT_EQ(byte(high.c[0]), 0xfd);
  EXPECT_EQ(byte(high.c[1]), 0xe7);
  EXPECT_EQ(byte(high.c[2]), 0x25);
  EXPECT_EQ(byte(color_at(ColorMap::magma, std::nanf("")).c[2]), 0x04);
}

TEST(ColorMaps, tell_neighbouring_numbers_apart) {
  EXPECT_EQ(luminance(color_of_number(0)), 0);
  for (std::uint32_t i = 1; i < 200; ++i) {
    const Rgb a = color_of_number(i), b = color_of_number(i + 1);
    float distance = 0;
    for (int c = 0; c < 3; ++c) distance += std::fabs(srgb_encode(a.c[c]) - srgb_encode(b.c[c]));
    EXPECT_GT(distance, 0.2f) << i;
  }
}

TEST(DisplayOfLayers, maps_the_zero_vector_to_black_and_the_others_to_halves) {
  const PixelBuffer normals = row_of({"X", "Y", "Z"}, {0, 0, 0, -1, 0, 1});
  const ChosenDisplay chosen = choose_display(normals, content_of_layer("N"), {}, false);
  EXPECT_EQ(to_display(normals, chosen.transform).values, (std::vector<std::uint8_t>{0, 0, 0, 0, 128, 255}));
}

TEST(DisplayOfLayers, shows_distances_over_their_range_and_nothing_as_black) {
  PixelBuffer depth = row_of({"Y"}, std::vector<float>(102));
  for (int i = 0; i < 100; ++i) depth.values[std::size_t(i)] = 50 + float(i);
  depth.values[100] = infinity;
  const ChosenDisplay chosen = choose_display(depth, content_of_layer("Z"), {}, false);
  ASSERT_TRUE(chosen.transform.range && chosen.range_chosen);
  EXPECT_NEAR(chosen.transform.range->low, 50, 1);
  EXPECT_NEAR(chosen.transform.range->high, 149, 2);
  const DisplayImage shown = to_display(depth, chosen.transform);
  ASSERT_EQ(shown.channel_count, 3);
  EXPECT_EQ(std::set<std::uint8_t>(shown.values.end() - 6, shown.values.end()), std::set<std::uint8_t>{0});
  std::set<std::uint8_t> greens;
  for (std::size_t i = 0; i < 300; i += 3) greens.insert(shown.values[i + 1]);
  EXPECT_GT(greens.size(), 50u);  // not plain white
}

TEST(DisplayOfLayers, shows_an_even_amount_in_one_colour_and_zero_at_the_bottom) {
  const PixelBuffer samples = row_of({"Y"}, {16, 16, 16, 0});
  const DisplayImage shown =
      to_display(samples, choose_display(samples, content_of_layer("samples"), {}, false).transform);
  EXPECT_EQ(shown.values[0], 0xfd);
  EXPECT_EQ(shown.values[9], 0x44);
}

TEST(DisplayOfLayers, takes_the_range_and_the_map_that_are_requested) {
  const PixelBuffer depth = row_of({"Y"}, {1, 2, 3});
  DisplayRequest request;
  request.range = ValueRange{1, 3}, request.no_map = true;
  const ChosenDisplay chosen = choose_display(depth, Content::distance, request, false);
  EXPECT_FALSE(chosen.range_chosen);
  EXPECT_EQ(choice_text(chosen), "");
  EXPECT_EQ(to_display(depth, chosen.transform).values, (std::vector<std::uint8_t>{0, 188, 255}));
  // An exposure shows any layer as light.
  DisplayRequest light;
  light.exposure = -1.0f;
  EXPECT_EQ(to_display(depth, choose_display(depth, Content::distance, light, false).transform).values,
            (std::vector<std::uint8_t>{188, 255, 255}));
}

PixelBuffer light_of(float scale, std::size_t count = 1000) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) values.push_back(scale * (0.5f + float(i) / float(count)));
  return row_of({"R", "G", "B"}, values);
}

TEST(AutomaticExposure, takes_the_log_average_to_the_key) {
  // The log-average of 0.5 ... 1.5 is e^(1.5 ln 1.5 - 0.5 ln 0.5 - 1).
  const float mean = std::exp(1.5f * std::log(1.5f) - 0.5f * std::log(0.5f) - 1);
  for (float scale : {1e-6f, 1.0f, 54351.0f})
    EXPECT_NEAR(automatic_exposure(light_of(scale)), std::log2(0.18f / (mean * scale)), 0.07f) << scale;
}

TEST(AutomaticExposure, is_not_moved_by_fireflies_or_by_black) {
  PixelBuffer image = light_of(1);
  const float before = automatic_exposure(image);
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t c = 0; c < 3; ++c) image.values[300 * i + c] = 1e20f;
  image.values[4] = infinity, image.values[3] = infinity, image.values[5] = infinity;
  EXPECT_NEAR(automatic_exposure(image), before, 0.11f);
  for (std::size_t i = 10; i < 20; ++i)
    for (std::size_t c = 0; c < 3; ++c) image.values[90 * i + c] = i % 2 ? 0.0f : 1e-20f;
  EXPECT_NEAR(automatic_exposure(image), before, 0.11f);
  EXPECT_EQ(automatic_exposure(row_of({"R", "G", "B"}, {0, 0, 0})), 0);
}

TEST(AutomaticExposure, is_the_default_only_where_the_picture_would_be_useless) {
  const auto chosen = [](const PixelBuffer& image, bool own = false, DisplayRequest request = {}) {
    return choose_display(image, Content::light, request, own);
  };
  EXPECT_FALSE(chosen(light_of(0.3f)).exposure_chosen);
  for (float scale : {1e-6f, 1000.0f}) {
    EXPECT_TRUE(chosen(light_of(scale)).exposure_chosen) << scale;
    EXPECT_FALSE(chosen(light_of(scale), true).exposure_chosen) << scale;
    DisplayRequest zero;
    zero.exposure = 0.0f;
    EXPECT_EQ(chosen(light_of(scale), false, zero).transform.exposure, 0) << scale;
  }
  DisplayRequest automatic;
  automatic.automatic_exposure = true;
  EXPECT_TRUE(chosen(light_of(0.3f), true, automatic).exposure_chosen);
  // Six in a hundred lit pixels within the range are enough to leave the picture alone; black ones do not count.
  PixelBuffer image = light_of(1000);
  for (std::size_t i = 0; i < 60; ++i)
    for (std::size_t c = 0; c < 3; ++c) image.values[3 * i + c] = 0.2f;
  EXPECT_FALSE(chosen(image).exposure_chosen);
  for (std::size_t i = 0; i < 60; ++i)
    for (std::size_t c = 0; c < 3; ++c) image.values[3 * i + c] = 0;
  EXPECT_TRUE(chosen(image).exposure_chosen);
  EXPECT_EQ(choice_text(chosen(light_of(1000))), "exposure -12.4 EV, chosen automatically");
}

}  // namespace
}  // namespace montelux::test
