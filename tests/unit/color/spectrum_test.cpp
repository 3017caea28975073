#include "color/spectrum.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace montelux {
namespace {

static_assert(!std::is_convertible_v<Rgb, Spectrum<float>> && !std::is_convertible_v<Spectrum<float>, Rgb>);

constexpr Rgb color{{0.2f, 0.5f, 0.9f}};

TEST(Spectrum, gives_back_the_colour_that_it_was_made_of) {
  const Rgb same = to_rgb(from_rgb(color));
  for (int i = 0; i < rgb_size; ++i) EXPECT_EQ(same.c[i], color.c[i]) << i;
}

TEST(Spectrum, has_green_in_each_component_beyond_blue_which_no_colour_shows) {
  Spectrum<float> carried = from_rgb(color);
  for (int i = 0; i < spectrum_size; ++i) EXPECT_EQ(carried.c[i], color.c[i < rgb_size ? i : 1]) << i;
  for (int i = rgb_size; i < spectrum_size; ++i) carried.c[i] = 7;
  EXPECT_EQ(max_component(to_rgb(carried)), 0.9f);
}

TEST(Spectrum, has_the_luminance_of_its_colour_alone) {
  EXPECT_FLOAT_EQ(luminance(to_rgb(from_rgb(color))), 0.2f * 0.212639f + 0.5f * 0.715169f + 0.9f * 0.072192f);
}

TEST(Spectrum, of_a_pack_has_the_components_of_its_lanes) {
  using F = NativeFloats;
  const Spectrum<F> pack = from_rgb(splat<F>(color));
  const Spectrum<float> one = from_rgb(color);
  for (int k = 0; k < native_lanes; ++k)
    for (int i = 0; i < spectrum_size; ++i) EXPECT_EQ(lane(pack, k).c[i], one.c[i]) << k << ' ' << i;
}

}  // namespace
}  // namespace montelux
