#include "image/image_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "image/direct_formats.h"
#include "image/display.h"
#include "image/image_codec.h"

namespace montelux {
namespace {

// A folder of its own for each test, removed at the end.
class ImageFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "montelux_image_XXXXXX").string();
    folder = mkdtemp(pattern.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string bytes(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::filesystem::path& path, std::string_view content) {
    std::ofstream(path, std::ios::binary).write(content.data(), std::streamsize(content.size()));
  }
  std::filesystem::path folder;
};

PixelBuffer ramp(std::vector<std::string> channels) {
  PixelBuffer image = make_pixel_buffer(5, 3, std::move(channels));
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = 0.37f * float(i) - 1.0f;
  return image;
}

TEST_F(ImageFile, exr_layers_come_back_bit_for_bit_under_their_names) {
  PixelBuffer image = ramp({"R", "G", "B"});
  append_layer(image, "stderr", ramp({"R", "G", "B"}));
  append_layer(image, "N", ramp({"X", "Y", "Z"}));
  append_layer(image, "", ramp({"Z", "samples", "material_id"}));
  ASSERT_TRUE(write_image(folder / "a.exr", image));
  Result<Image> back = read_image(folder / "a.exr");
  ASSERT_TRUE(back) << back.error();
  EXPECT_EQ(back->stored, SampleType::float32);
  EXPECT_EQ(back->pixels.channel_count(), 12);
  for (const std::string& name : image.channels) {
    std::optional<int> place = find_channel(back->pixels, name);
    ASSERT_TRUE(place) << name;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        EXPECT_EQ(back->pixels.at(x, y, *place), image.at(x, y, *find_channel(image, name)));
  }
  std::optional<PixelBuffer> error = layer(back->pixels, "stderr");
  ASSERT_TRUE(error);
  EXPECT_EQ(error->channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(error->values, ramp({"R", "G", "B"}).values);
  EXPECT_FALSE(layer(back->pixels, "albedo"));
}

TEST_F(ImageFile, exr_header_keeps_the_types_of_its_entries) {
  ExrOptions options;
  options.attributes = {{"integrator", "path"}, {"passes", std::int32_t(64)}, {"exposure", 1.5f}, {"seconds", 0.1}};
  ASSERT_TRUE(write_image(folder / "a.exr", ramp({"R", "G", "B"}), options));
  Result<Image> back = read_image(folder / "a.exr");
  ASSERT_TRUE(back) << back.error();
  for (const Attribute& attribute : options.attributes)
    EXPECT_NE(std::find(back->attributes.begin(), back->attributes.end(), attribute), back->attributes.end())
        << attribute.name;
}

TEST_F(ImageFile, half_channels_are_rounded_to_half_and_the_others_are_not) {
  PixelBuffer image = make_pixel_buffer(1, 1, {"R", "G", "B"});
  image.values = {1.0f / 3.0f, 1e6f, 1.0f / 3.0f};
  ExrOptions options;
  options.half_channels = {"R", "G"};
  ASSERT_TRUE(write_image(folder / "a.exr", image, options));
  Result<Image> back = read_image(folder / "a.exr");
  ASSERT_TRUE(back) << back.error();
  EXPECT_EQ(back->pixels.values, (std::vector<float>{0.333251953125f, 65504.0f, 1.0f / 3.0f}));
}

TEST_F(ImageFile, exr_and_png_bytes_depend_on_nothing_but_the_image) {
  for (const char* name : {"a.exr", "b.exr"}) ASSERT_TRUE(write_image(folder / name, ramp({"R", "G", "B"})));
  EXPECT_EQ(bytes(folder / "a.exr"), bytes(folder / "b.exr"));
  EXPECT_EQ(bytes(folder / "a.exr").find("capDate"), std::string::npos);
  for (const char* name : {"a.png", "b.png"})
    ASSERT_TRUE(write_image(folder / name, to_display(ramp({"R", "G", "B"}))));
  EXPECT_EQ(bytes(folder / "a.png"), bytes(folder / "b.png"));
}

TEST_F(ImageFile, exr_bytes_are_the_same_in_one_buffer_and_by_rows_of_any_number_of_threads) {
  PixelBuffer image = make_pixel_buffer(37, 275, {"R", "G", "B", "N.X"});
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = std::sin(float(i));
  ExrOptions options{{{"key", std::string("value")}}, {"R", "G", "B"}};
  int rows_made = 0;
  const auto rows = [&](int first, int count) {
    EXPECT_EQ(first, rows_made);
    EXPECT_LE(count, exr_rows_together(options.threads));
    rows_made += count;
    return rows_of(image, first, count);
  };
  const Result<std::string> whole = encode_image("a.exr", image, options);
  for (int threads : {1, 2, 3, 0}) {
    options.threads = threads, rows_made = 0;
    const Result<std::string> by_rows = encode_exr("a.exr", {37, 275, image.channels, rows}, options);
    ASSERT_TRUE(whole && by_rows);
    EXPECT_EQ(rows_made, 275);
    EXPECT_TRUE(*whole == *by_rows) << threads;
  }
  rows_made = 0;
  EXPECT_EQ(encode_exr("a.exr", {0, 0, image.channels, rows}).error(), "cannot write 'a.exr': the image is empty");
}

TEST_F(ImageFile, date_is_that_of_the_environment_or_absent) {
  unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_FALSE(date_attribute());
  setenv("SOURCE_DATE_EPOCH", "86400", 1);
  std::optional<Attribute> date = date_attribute();
  unsetenv("SOURCE_DATE_EPOCH");
  ASSERT_TRUE(date);
  EXPECT_EQ(*date, (Attribute{"capDate", "1970:01:02 00:00:00"}));
}

TEST_F(ImageFile, png_bytes_are_decoded_as_srgb_or_as_requested) {
  DisplayImage picture{2, 1, 3, {0, 128, 255, 64, 10, 200}};
  ASSERT_TRUE(write_image(folder / "a.png", picture));
  Result<Image> srgb = read_image(folder / "a.png");
  ASSERT_TRUE(srgb) << srgb.error();
  EXPECT_EQ(srgb->stored, SampleType::uint8);
  EXPECT_EQ(to_string(srgb->encoding), "sRGB");
  EXPECT_NEAR(srgb->pixels.at(0, 0, 1), 0.2158605f, 1e-6f);
  EXPECT_EQ(to_display(srgb->pixels).values, picture.values);
  Result<Image> linear = read_image(folder / "a.png", ColorEncoding{});
  ASSERT_TRUE(linear);
  EXPECT_NEAR(linear->pixels.at(0, 0, 1), 128.0f / 255.0f, 1e-7f);
  Result<Image> gamma = read_image(folder / "a.png", parse_encoding("gamma 2"));
  ASSERT_TRUE(gamma);
  EXPECT_NEAR(gamma->pixels.at(0, 0, 1), 128.0f / 255.0f * 128.0f / 255.0f, 1e-6f);
}

TEST_F(ImageFile, gray_jpeg_reads_as_one_channel) {
  DisplayImage picture{16, 16, 1, std::vector<std::uint8_t>(256, 100)};
  ASSERT_TRUE(write_image(folder / "a.jpg", picture));
  Result<Image> back = read_image(folder / "a.jpg", ColorEncoding{});
  ASSERT_TRUE(back) << back.error();
  EXPECT_EQ(back->pixels.channel_count(), 1);
  EXPECT_NEAR(back->pixels.at(3, 3, 0), 100.0f / 255.0f, 1.5f / 255.0f);
}

TEST_F(ImageFile, uncompressed_tga_reads_with_its_top_row_first) {
  // A 1 x 2 true-colour TGA whose first stored row is the bottom one: blue below red.
  std::string tga("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\2\0\30\0", 18);
  tga += std::string("\xff\0\0\0\0\xff", 6);
  write(folder / "a.tga", tga);
  Result<Image> back = read_image(folder / "a.tga");
  ASSERT_TRUE(back) << back.error();
  EXPECT_EQ(back->pixels.values, (std::vector<float>{1, 0, 0, 0, 0, 1}));
}

TEST_F(ImageFile, pfm_reads_from_the_bottom_row_up) {
  std::string pfm = "PF\n1 2\n-1.0\n";
  float values[6] = {0.5f, 1.5f, 2.5f, 10.0f, 20.0f, 30.0f};
  pfm.append(reinterpret_cast<const char*>(values), sizeof values);
  write(folder / "a.pfm", pfm);
  Result<Image> back = read_image(folder / "a.pfm");
  ASSERT_TRUE(back) << back.error();
  EXPECT_EQ(to_string(back->encoding), "linear");
  EXPECT_EQ(back->pixels.values, (std::vector<float>{10, 20, 30, 0.5f, 1.5f, 2.5f}));
}

TEST_F(ImageFile, hdr_and_pfm_come_back_within_their_precision) {
  PixelBuffer image = ramp({"R", "G", "B"});
  for (float& value : image.values) value = std::fabs(value) + 1.0f;
  for (const char* name : {"a.hdr", "a.pfm"}) {
    Status written = write_image(folder / name, image);
    ASSERT_TRUE(written) << written.error();
    Result<Image> back = read_image(folder / name);
    ASSERT_TRUE(back) << back.error();
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < 3; ++c) {
          float tolerance = std::string_view(name) == "a.hdr" ? image.at(x, y, 0) / 64.0f + 0.1f : 0.0f;
          EXPECT_NEAR(back->pixels.at(x, y, c), image.at(x, y, c), tolerance) << name;
        }
  }
}

TEST_F(ImageFile, missing_corrupt_and_truncated_files_are_explained) {
  Result<Image> missing = read_image(folder / "none.png");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().find("none.png"), std::string::npos);
  EXPECT_NE(missing.error().find("no such file"), std::string::npos);
  EXPECT_FALSE(read_image(folder));

  for (const char* name : {"a.png", "a.exr", "a.jpg", "a.hdr", "a.pfm", "a.tga", "a.xyz"}) {
    write(folder / name, "this is no image at all");
    EXPECT_FALSE(read_image(folder / name)) << name;
    write(folder / name, "");
    EXPECT_FALSE(read_image(folder / name)) << name;
  }
  ASSERT_TRUE(write_image(folder / "whole.exr", make_pixel_buffer(64, 64, {"R", "G", "B"})));
  std::string whole = bytes(folder / "whole.exr");
  write(folder / "part.exr", std::string_view(whole).substr(0, whole.size() / 2));
  EXPECT_FALSE(read_image(folder / "part.exr"));
}

TEST_F(ImageFile, absurd_sizes_are_refused_before_memory_is_taken) {
  write(folder / "a.pfm", "PF\n1000000 1000000\n-1.0\n1234");
  Result<Image> back = read_image(folder / "a.pfm");
  ASSERT_FALSE(back);
  std::string ppm = "P6\n60000 60000\n255\n1234";
  write(folder / "a.ppm", ppm);
  EXPECT_FALSE(read_image(folder / "a.ppm"));
}

TEST_F(ImageFile, a_header_that_promises_more_than_the_file_can_hold_is_refused) {
  // 70 MB of samples: what an empty picture of that size is packed to holds them, a part of it does not.
  ASSERT_TRUE(write_image(folder / "empty.exr", make_pixel_buffer(4200, 4200, {"Y"})));
  EXPECT_TRUE(read_image(folder / "empty.exr"));
  const std::string whole = bytes(folder / "empty.exr");
  write(folder / "part.exr", std::string_view(whole).substr(0, 3000));
  const Result<Image> part = read_image(folder / "part.exr");
  ASSERT_FALSE(part);
  EXPECT_NE(part.error().find("states 4200 x 4200 pixels"), std::string::npos) << part.error();
}

TEST_F(ImageFile, a_picture_that_is_too_wide_for_jpeg_is_a_failure) {
  const Status written = write_image(folder / "a.jpg", DisplayImage{65501, 1, 1, std::vector<std::uint8_t>(65501)});
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().find("at most 65500 pixels per side"), std::string::npos) << written.error();
  EXPECT_TRUE(write_image(folder / "a.jpg", DisplayImage{65500, 1, 1, std::vector<std::uint8_t>(65500)}));
}

TEST_F(ImageFile, a_failed_write_leaves_nothing_behind) {
  EXPECT_FALSE(write_image(folder / "no" / "such" / "folder.exr", ramp({"R"})));
  EXPECT_FALSE(write_image(folder / "a.unknown", ramp({"R"})));
  EXPECT_FALSE(write_image(folder / "a.unknown", DisplayImage{1, 1, 1, {7}}));
  EXPECT_FALSE(write_image(folder / "a.exr", PixelBuffer{}));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  ASSERT_TRUE(write_image(folder / "a.exr", ramp({"R"})));
  ASSERT_TRUE(write_image(folder / "a.exr", ramp({"G"})));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(Display, curves_are_monotone_and_stay_in_range) {
  for (ToneCurve curve : {ToneCurve::clip, ToneCurve::hable, ToneCurve::aces}) {
    float last = 0.0f;
    for (float x = 0.0f; x < 1e6f; x = x * 1.1f + 1e-4f) {
      float y = apply_curve(curve, x);
      EXPECT_GE(y, last);
      EXPECT_LE(y, 1.0f);
      last = y;
    }
    EXPECT_EQ(apply_curve(curve, std::numeric_limits<float>::quiet_NaN()), 0.0f);
    EXPECT_EQ(apply_curve(curve, std::numeric_limits<float>::infinity()), 1.0f);
  }
  EXPECT_NEAR(apply_curve(ToneCurve::hable, 5.6f), 1.0f, 1e-6f);
  EXPECT_NEAR(apply_curve(ToneCurve::aces, 1.0f), 0.803797f, 1e-5f);
}

TEST(Display, one_stop_of_exposure_doubles_the_light) {
  PixelBuffer image = make_pixel_buffer(1, 1, {"R", "G", "B"});
  image.values = {0.1f, 0.2f, 0.5f};
  DisplayImage brighter = to_display(image, {1.0f, ToneCurve::clip});
  EXPECT_EQ(brighter.values, (std::vector<std::uint8_t>{124, 170, 255}));
}

// PNG files of 2 x 1 pixels: gray of 16 bits, 0x0102 and 0xfffe; a palette, green and red; gray and RGB with alpha.
constexpr unsigned char gray_alpha_png[] = {
    0x89, 0x50, 0x4e, 0x47, 0xd,  0xa,  0x1a, 0xa,  0x0,  0x0,  0x0,  0xd,  0x49, 0x48, 0x44, 0x52, 0x0, 0x0,
    0x0,  0x2,  0x0,  0x0,  0x0,  0x1,  0x8,  0x4,  0x0,  0x0,  0x0,  0x5e, 0x2b, 0xb7, 0x1,  0x0,  0x0, 0x0,
    0xd,  0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x10, 0x68, 0x38, 0xf1, 0x1f, 0x0,  0x4,  0x54, 0x2, 0x58,
    0x17, 0x6,  0x1f, 0x77, 0x0,  0x0,  0x0,  0x0,  0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
constexpr unsigned char rgba_png[] = {
    0x89, 0x50, 0x4e, 0x47, 0xd,  0xa,  0x1a, 0xa,  0x0,  0x0,  0x0,  0xd,  0x49, 0x48, 0x44, 0x52, 0x0, 0x0,  0x0,
    0x2,  0x0,  0x0,  0x0,  0x1,  0x8,  0x6,  0x0,  0x0,  0x0,  0xf4, 0x22, 0x7f, 0x8a, 0x0,  0x0,  0x0, 0x11, 0x49,
    0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x64, 0x62, 0x6e, 0xf8, 0xf5, 0xfb, 0xcf, 0x7f, 0x0,  0xc, 0x81, 0x4,
    0x77, 0x84, 0x1,  0xfd, 0x8,  0x0,  0x0,  0x0,  0x0,  0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
constexpr unsigned char wide_png[] = {
    0x89, 0x50, 0x4e, 0x47, 0xd,  0xa,  0x1a, 0xa,  0x0,  0x0,  0x0,  0xd,  0x49, 0x48, 0x44, 0x52, 0x0, 0x0,
    0x0,  0x2,  0x0,  0x0,  0x0,  0x1,  0x10, 0x0,  0x0,  0x0,  0x0,  0x81, 0xd9, 0xfc, 0x15, 0x0,  0x0, 0x0,
    0xd,  0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x64, 0xfa, 0xff, 0xf,  0x0,  0x3,  0xb,  0x2, 0x1,
    0x84, 0x91, 0xe8, 0x13, 0x0,  0x0,  0x0,  0x0,  0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
constexpr unsigned char palette_png[] = {
    0x89, 0x50, 0x4e, 0x47, 0xd,  0xa,  0x1a, 0xa,  0x0,  0x0,  0x0,  0xd,  0x49, 0x48, 0x44, 0x52, 0x0,  0x0,
    0x0,  0x2,  0x0,  0x0,  0x0,  0x1,  0x8,  0x3,  0x0,  0x0,  0x0,  0xc3, 0xfc, 0x8f, 0xb8, 0x0,  0x0,  0x0,
    0x6,  0x50, 0x4c, 0x54, 0x45, 0xff, 0x0,  0x0,  0x0,  0xff, 0x0,  0xd2, 0x87, 0xef, 0x71, 0x0,  0x0,  0x0,
    0xb,  0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x64, 0x0,  0x0,  0x0,  0x5,  0x0,  0x2,  0xd1, 0x66,
    0x33, 0x78, 0x0,  0x0,  0x0,  0x0,  0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

template <std::size_t N>
std::string text_of(const unsigned char (&bytes)[N]) {
  return {std::begin(bytes), std::end(bytes)};
}

TEST_F(ImageFile, png_and_jpeg_are_the_same_directly_and_by_the_module) {
  DisplayImage gray{37, 23, 1, {}}, rgb{37, 23, 3, {}};
  for (DisplayImage* image : {&gray, &rgb})
    for (int i = 0; i < 37 * 23 * image->channel_count; ++i) image->values.push_back(std::uint8_t(i * i * 7 + i));
  const std::pair<std::string, Result<std::string>> files[] = {
      {"a.png", encode_png(gray)}, {"a.png", encode_png(rgb)},         {"a.jpg", encode_jpeg(gray)},
      {"a.jpg", encode_jpeg(rgb)}, {"a.png", text_of(gray_alpha_png)}, {"a.png", text_of(rgba_png)},
      {"a.png", text_of(wide_png)}};
  const int channels[] = {1, 3, 1, 3, 2, 4, 1};
  for (std::size_t i = 0; i < std::size(files); ++i) {
    SCOPED_TRACE(i);
    const auto& [name, file] = files[i];
    ASSERT_TRUE(file) << file.error();
    const std::optional<StoredImage> direct = read_directly(*file);
    const Result<StoredImage> module = (*image_codec())->read(name, &*file);
    ASSERT_TRUE(direct && module);
    EXPECT_EQ(direct->parts.front().channel_count(), channels[i]);
    EXPECT_EQ(direct->parts.front().channels, module->parts.front().channels);
    EXPECT_EQ(direct->parts.front().width, module->parts.front().width);
    EXPECT_EQ(direct->parts.front().height, module->parts.front().height);
    EXPECT_EQ(direct->parts.front().values, module->parts.front().values);
    EXPECT_EQ(direct->stored, module->stored);
    EXPECT_EQ(direct->alpha_channel, module->alpha_channel);
    // Damaged files are left to the module.
    EXPECT_FALSE(read_directly(std::string_view(*file).substr(0, file->size() / 2)));
  }
  EXPECT_EQ(read_directly(text_of(wide_png))->parts.front().values,
            (std::vector<float>{0x0102 / 65535.0f, 0xfffe / 65535.0f}));
  EXPECT_FALSE(read_directly("no image"));
  EXPECT_FALSE(read_directly(text_of(palette_png)));
  const Result<Image> colors = read_image("a.png", text_of(palette_png), ColorEncoding{});
  ASSERT_TRUE(colors) << colors.error();
  EXPECT_EQ(colors->pixels.values, (std::vector<float>{0, 1, 0, 1, 0, 0}));
}

// The library of PNG files has words of its own for damage, which would come besides our message.
TEST_F(ImageFile, damaged_png_is_refused_in_one_message) {
  ASSERT_TRUE(write_image(folder / "whole.png", to_display(ramp({"R", "G", "B"}))));
  const std::string whole = bytes(folder / "whole.png");
  ASSERT_TRUE(read_image(folder / "whole.png"));
  ASSERT_TRUE(read_image("whole", whole));
  for (std::size_t at = 8; at < whole.size(); ++at) {
    std::string damaged = whole, cut = whole.substr(0, at);
    damaged[at] = char(damaged[at] ^ 0x55);
    std::ofstream(folder / "damaged.png", std::ios::binary) << damaged;
    testing::internal::CaptureStderr();
    const Result<Image> a = read_image(folder / "damaged.png"), b = read_image("cut", cut);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << at;
    ASSERT_TRUE(!a && !b) << at;
    EXPECT_EQ(a.error().find('\n'), std::string::npos) << a.error();
  }
}

}  // namespace
}  // namespace montelux
