#include "texture/texel_image.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "math/square_maps.h"
#include "mc/random.h"

namespace montelux {
namespace {

// A file in the temporary folder that goes away with the object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("montelux_texel_" + std::to_string(::getpid()) + "_" + name)) {}
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// IEC 61966-2-1.
double published_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

TEST(TexelImage, eight_bit_codes_decode_by_the_published_formulas) {
  TemporaryFile file("ramp.png");
  DisplayImage ramp{256, 1, 1, {}};
  for (int i = 0; i < 256; ++i) ramp.values.push_back(std::uint8_t(i));
  ASSERT_TRUE(write_image(file.path(), ramp));
  auto check = [&](const char* encoding, auto formula) {
    Result<TexelImage> image = TexelImage::read(file.path(), parse_encoding(encoding));
    ASSERT_TRUE(image);
    EXPECT_TRUE(image->is_gray());
    EXPECT_EQ(image->bytes(), 256u);
    for (int i = 0; i < 256; ++i) EXPECT_NEAR(image->texel(i, 0)[1], formula(i / 255.0), 2e-6) << encoding << " " << i;
  };
  check("", published_srgb);
  check("sRGB", published_srgb);
  check("linear", [](double v) { return v; });
  check("gamma 1.8", [](double v) { return std::pow(v, 1.8); });
}

TEST(TexelImage, halves_are_kept_as_halves_and_floating_point_files_are_linear) {
  TemporaryFile file("half.exr");
  PixelBuffer pixels = make_pixel_buffer(3, 2, {"R", "G", "B"});
  for (std::size_t i = 0; i < pixels.values.size(); ++i) pixels.values[i] = float(i) * 0.375f;
  ASSERT_TRUE(write_image(file.path(), pixels, {{}, {"R", "G", "B"}}));
  Result<TexelImage> image = TexelImage::read(file.path(), parse_encoding("sRGB"));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->bytes(), 36u);
  EXPECT_EQ(image->texel(1, 1)[2], pixels.at(1, 1, 2));
}

TEST(TexelImage, a_missing_file_is_an_error_that_names_it) {
  Result<TexelImage> image = TexelImage::read("/no/such/picture.png", std::nullopt);
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().find("picture.png"), std::string::npos);
}

TEST(Half, every_half_survives_the_way_through_float) {
  for (std::uint32_t bits = 0; bits < 0x10000u; ++bits) {
    float x = half_to_float(std::uint16_t(bits));
    if (std::isnan(x)) continue;
    ASSERT_EQ(float_to_half(x), bits) << x;
  }
}

TEST(Half, rounds_to_the_nearest_with_ties_to_even) {
  EXPECT_EQ(half_to_float(0x3c00), 1.0f);
  EXPECT_EQ(half_to_float(0x7bff), 65504.0f);
  EXPECT_EQ(half_to_float(0x0001), 0x1p-24f);
  EXPECT_EQ(float_to_half(1.0f / 3), 0x3555);
  EXPECT_EQ(float_to_half(1.0f + 0x1p-11f), 0x3c00);
  EXPECT_EQ(float_to_half(1.0f + 3 * 0x1p-11f), 0x3c02);
  EXPECT_EQ(float_to_half(0x1p-25f), 0x0000);
  EXPECT_EQ(float_to_half(65519.9f), 0x7bff);
  EXPECT_EQ(float_to_half(65520.0f), 0x7c00);
  EXPECT_EQ(float_to_half(-2.0f), 0xc000);
  EXPECT_TRUE(std::isnan(half_to_float(float_to_half(std::nanf("")))));
}

// Values 1, 2, 3 over 4, 5, 6.
TexelImage three_by_two() {
  PixelBuffer pixels = make_pixel_buffer(3, 2, {"Y"});
  for (int i = 0; i < 6; ++i) pixels.values[std::size_t(i)] = float(i + 1);
  return TexelImage::from(pixels);
}

TEST(TexelImage, bilinear_is_exact_at_centres_and_linear_between) {
  TexelImage image = three_by_two();
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x)
      EXPECT_NEAR(image.bilinear_number({(float(x) + 0.5f) / 3, (float(y) + 0.5f) / 2}, Wrap::clamp),
                  float(3 * y + x + 1), 1e-6f);
  EXPECT_NEAR(image.bilinear_number({1.0f / 3, 0.25f}, Wrap::clamp), 1.5f, 1e-6f);
  EXPECT_NEAR(image.bilinear_number({0.5f, 0.5f}, Wrap::clamp), 3.5f, 1e-6f);
  EXPECT_NEAR(image.bilinear({0.5f, 0.5f}, Wrap::clamp)[2], 3.5f, 1e-6f);
}

TEST(TexelImage, wrap_modes_continue_the_image_as_they_say) {
  TexelImage image = three_by_two();
  EXPECT_NEAR(image.bilinear_number({0, 0.25f}, Wrap::clamp), 1, 1e-6f);
  EXPECT_NEAR(image.bilinear_number({0, 0.25f}, Wrap::repeat), 2, 1e-6f);
  EXPECT_NEAR(image.bilinear_number({0, 0.25f}, Wrap::black), 0.5f, 1e-6f);
  EXPECT_NEAR(image.bilinear_number({0, 0.25f}, Wrap::octahedral), 2.5f, 1e-6f);
  EXPECT_NEAR(image.bilinear_number({0.5f, 0}, Wrap::octahedral), 2, 1e-6f);
  EXPECT_EQ(image.nearest_number({-0.1f, 0.1f}, Wrap::repeat), 3);
  EXPECT_EQ(image.nearest_number({-7.1f, 12.6f}, Wrap::repeat), 6);
  EXPECT_EQ(image.nearest_number({-0.1f, 0.1f}, Wrap::clamp), 1);
  EXPECT_EQ(image.nearest_number({5, 9}, Wrap::clamp), 6);
  EXPECT_EQ(image.nearest_number({1.01f, 0.1f}, Wrap::black), 0);
}

TEST(TexelImage, places_that_are_huge_or_not_numbers_stay_inside_the_image) {
  TexelImage image = three_by_two();
  for (Wrap wrap : {Wrap::repeat, Wrap::black, Wrap::clamp, Wrap::octahedral})
    for (float s : {1e30f, -1e30f, INFINITY, -INFINITY, std::nanf("")}) {
      image.nearest({s, s}, wrap);
      image.bilinear({s, -s}, wrap);
    }
}

// A pack of look-ups gives the bits of single ones, for each way to hold texels and beyond the edges.
TEST(TexelImage, packs_find_what_single_look_ups_find) {
  using F = NativeFloats;
  RandomStream<float> random(3u, 4u);
  const auto compare = [&](const TexelImage& image) {
    for (Wrap wrap : {Wrap::repeat, Wrap::black, Wrap::clamp, Wrap::octahedral})
      for (int round = 0; round < 200; ++round) {
        Vec2<F> st;
        for (int k = 0; k < native_lanes; ++k) {
          Vec2f at{3 * random.next() - 1, 3 * random.next() - 1};
          // On the edges, and far out, too.
          if (round % 4 == 1) at = {std::round(at.x), std::round(at.y)};
          if (round % 4 == 2) at = {k % 2 ? std::nanf("") : 1e30f, -INFINITY};
          set_lane(st, k, at);
        }
        const Mask<F> on = mask_of_bits<F>(std::uint32_t(random.next() * 0x1p16f) | 1u);
        const RgbOf<F> pack = image.bilinear(st, wrap, on);
        for (int k = 0; k < native_lanes; ++k) {
          const Rgb one = lane(on, k) ? image.bilinear(lane(st, k), wrap) : Rgb{};
          for (int i = 0; i < rgb_size; ++i) ASSERT_EQ(lane(pack.c[i], k), one.c[i]) << int(wrap) << round;
        }
      }
  };
  compare(three_by_two());
  for (const int channels : {1, 3}) {
    TemporaryFile file("pack" + std::to_string(channels) + ".png");
    DisplayImage picture{13, 7, channels, {}};
    for (int i = 0; i < 13 * 7 * channels; ++i) picture.values.push_back(std::uint8_t(i * 37));
    ASSERT_TRUE(write_image(file.path(), picture));
    compare(*TexelImage::read(file.path(), std::nullopt));
  }
  TemporaryFile file("pack.exr");
  PixelBuffer pixels = make_pixel_buffer(5, 4, {"R", "G", "B"});
  for (std::size_t i = 0; i < pixels.values.size(); ++i) pixels.values[i] = float(i) * 0.375f;
  ASSERT_TRUE(write_image(file.path(), pixels, {{}, {"R", "G", "B"}}));
  compare(*TexelImage::read(file.path(), std::nullopt));
  compare(TexelImage::from(pixels));
}

TEST(TexelImage, octahedral_wrap_makes_an_image_of_the_sphere_continuous_across_its_edge) {
  const int n = 256;
  PixelBuffer pixels = make_pixel_buffer(n, n, {"R", "G", "B"});
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      Vec3f w = sphere_from_square(Vec2f{(float(x) + 0.5f) / n, (float(y) + 0.5f) / n});
      pixels.at(x, y, 0) = w.x, pixels.at(x, y, 1) = w.y, pixels.at(x, y, 2) = w.z;
    }
  // z has a crease along the edge, of slope 4 at most, and the nearest centres are half a texel away.
  const float bound = 4 * 0.5f / n + 1e-3f;
  TexelImage image = TexelImage::from(pixels);
  for (float t : {0.0f, 0.1f, 0.37f, 0.5f, 0.8f, 1.0f})
    for (Vec2f st : {Vec2f{0, t}, Vec2f{1, t}, Vec2f{t, 0}, Vec2f{t, 1}}) {
      Rgb c = image.bilinear(st, Wrap::octahedral);
      Vec3f w = sphere_from_square(st);
      EXPECT_NEAR(c[0], w.x, bound);
      EXPECT_NEAR(c[1], w.y, bound);
      EXPECT_NEAR(c[2], w.z, bound);
    }
}

TEST(TexelImage, a_number_is_the_mean_of_the_colour_or_alpha_where_that_says_something) {
  PixelBuffer pixels = make_pixel_buffer(1, 1, {"R", "G", "B", "A"});
  pixels.values = {0.1f, 0.2f, 0.6f, 1.0f};
  EXPECT_FALSE(TexelImage::from(pixels).has_alpha());
  EXPECT_NEAR(TexelImage::from(pixels).bilinear_number({0.5f, 0.5f}, Wrap::clamp), 0.3f, 1e-6f);
  pixels.values[3] = 0.25f;
  EXPECT_TRUE(TexelImage::from(pixels).has_alpha());
  EXPECT_NEAR(TexelImage::from(pixels).bilinear_number({0.5f, 0.5f}, Wrap::clamp), 0.25f, 1e-6f);
  EXPECT_NEAR(TexelImage::from(pixels).nearest({0.5f, 0.5f}, Wrap::clamp)[2], 0.6f, 1e-6f);
}

TEST(TexelImage, average_is_the_mean_of_a_part) {
  EXPECT_NEAR(three_by_two().average(0, 0, 3, 2)[0], 3.5f, 1e-6f);
  EXPECT_NEAR(three_by_two().average(1, 0, 3, 1)[0], 2.5f, 1e-6f);
}

}  // namespace
}  // namespace montelux
