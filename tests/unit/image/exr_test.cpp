// OpenEXR files that are read directly, against the module of image formats, which reads them by other code.
#include "image/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace montelux {

namespace {

constexpr int width = 37, height = 23;

std::vector<float> noise(std::uint32_t seed) {
  std::vector<float> values;
  for (std::uint32_t i = 0; i < std::uint32_t(width) * height; ++i)
    values.push_back(float((i * 2654435761u + seed) >> 8) * 0x1p-20f - 3.0f);
  return values;
}

class ExrFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "montelux_exr_XXXXXX").string();
    file = std::filesystem::path(mkdtemp(pattern.data())) / "a.exr";
  }
  void TearDown() override { std::filesystem::remove_all(file.parent_path()); }

  std::string bytes() const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  Result<StoredImage> by_module() const { return (*image_codec())->read(file, nullptr); }

  // The same in the file and in memory as by the module, whose channels have an order of their own.
  void expect_same() const {
    const std::string content = bytes();
    const Result<StoredImage> module = by_module();
    ASSERT_TRUE(module) << module.error();
    for (const std::string* in_memory : {static_cast<const std::string*>(nullptr), &content}) {
      const std::optional<StoredImage> direct = read_exr(file, in_memory);
      ASSERT_TRUE(direct);
      const PixelBuffer &own = direct->parts.front(), &theirs = module->parts.front();
      EXPECT_EQ(own.width, theirs.width);
      EXPECT_EQ(own.height, theirs.height);
      ASSERT_EQ(own.channels.size(), theirs.channels.size());
      for (int c = 0; c < own.channel_count(); ++c) {
        const std::optional<int> there = find_channel(theirs, own.channels[std::size_t(c)]);
        ASSERT_TRUE(there) << own.channels[std::size_t(c)];
        for (int y = 0; y < own.height; ++y)
          for (int x = 0; x < own.width; ++x) ASSERT_EQ(own.at(x, y, c), theirs.at(x, y, *there));
      }
      EXPECT_EQ(direct->stored, module->stored);
      ASSERT_EQ(direct->alpha_channel < 0, module->alpha_channel < 0);
      if (direct->alpha_channel < 0) continue;
      EXPECT_EQ(own.channels[std::size_t(direct->alpha_channel)], theirs.channels[std::size_t(module->alpha_channel)]);
    }
  }
  void expect_left_to_module() const {
    const std::string content = bytes();
    EXPECT_FALSE(read_exr(file, nullptr));
    EXPECT_FALSE(read_exr(file, &content));
  }

  std::filesystem::path file;
};

struct Kind {
  std::vector<std::pair<std::string, Imf::Channel>> channels;
  Imf::Compression compression = Imf::PIZ_COMPRESSION;
  Imath::V2i origin{0, 0};
  Imf::LineOrder order = Imf::INCREASING_Y;
};

struct Content {
  Imf::Header header;
  Imf::FrameBuffer frame;
  std::vector<std::vector<float>> planes;
  std::vector<std::vector<half>> halves;
  std::vector<std::vector<unsigned>> wholes;

  explicit Content(const Kind& kind) {
    const Imath::Box2i window(kind.origin, kind.origin + Imath::V2i(width - 1, height - 1));
    header = Imf::Header(window, window);
    header.compression() = kind.compression, header.lineOrder() = kind.order;
    std::uint32_t seed = 0;
    for (const auto& [name, channel] : kind.channels) {
      header.channels().insert(name, channel);
      const auto values = noise(++seed * 77777777u);
      const auto insert = [&](auto& plane, std::size_t size) {
        char* base = reinterpret_cast<char*>(plane.data()) -
                     std::ptrdiff_t(size) * (kind.origin.x + std::ptrdiff_t(kind.origin.y) * width);
        frame.insert(name, Imf::Slice(channel.type, base, size, size * width, channel.xSampling, channel.ySampling));
      };
      if (channel.type == Imf::FLOAT) insert(planes.emplace_back(values), sizeof(float));
      if (channel.type == Imf::HALF) insert(halves.emplace_back(values.begin(), values.end()), sizeof(half));
      if (channel.type == Imf::UINT) insert(wholes.emplace_back(values.size(), 7u), sizeof(unsigned));
    }
  }
};

void write(const std::filesystem::path& file, const Kind& kind) {
  const Content content(kind);
  Imf::OutputFile out(file.c_str(), content.header);
  out.setFrameBuffer(content.frame);
  out.writePixels(height);
}

const Imf::Channel whole(Imf::FLOAT), small(Imf::HALF);

TEST_F(ExrFile, is_the_same_directly_and_by_the_module) {
  const Kind kinds[] = {{{{"R", small}, {"G", small}, {"B", small}}},
                        {{{"R", whole}, {"G", whole}, {"B", whole}, {"A", whole}}, Imf::ZIP_COMPRESSION},
                        {{{"Y", small}}, Imf::NO_COMPRESSION},
                        {{{"R", whole},
                          {"G", small},
                          {"B", small},
                          {"albedo.R", small},
                          {"albedo.A", whole},
                          {"P.X", whole},
                          {"P.Z", whole}},
                         Imf::ZIPS_COMPRESSION},
                        {{{"R", whole}, {"G", whole}, {"B", whole}}, Imf::RLE_COMPRESSION, {-5, 11}},
                        {{{"r", small}, {"g", small}, {"b", small}, {"Alpha", small}},
                         Imf::PXR24_COMPRESSION,
                         {9, -4},
                         Imf::DECREASING_Y},
                        {{{"R", whole}, {"G", whole}, {"B", whole}}, Imf::DWAA_COMPRESSION}};
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(kind.channels.front().first + std::to_string(int(kind.compression)));
    write(file, kind);
    expect_same();
  }
}

TEST_F(ExrFile, of_tiles_is_the_same_directly_and_by_the_module) {
  Content content({{{"R", whole}, {"G", whole}, {"B", small}}, Imf::ZIP_COMPRESSION, {3, -2}});
  content.header.setTileDescription(Imf::TileDescription(16, 8));
  {
    Imf::TiledOutputFile out(file.c_str(), content.header);
    out.setFrameBuffer(content.frame);
    out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
  }
  expect_same();
}

TEST_F(ExrFile, has_colours_and_alpha_first_and_the_other_channels_by_name) {
  write(file, {{{"P.Z", whole},
                {"P.Y", whole},
                {"P.X", whole},
                {"Z", whole},
                {"A", whole},
                {"R", whole},
                {"G", whole},
                {"B", whole}}});
  const std::optional<StoredImage> image = read_exr(file, nullptr);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->parts.front().channels, (std::vector<std::string>{"R", "G", "B", "A", "Z", "P.X", "P.Y", "P.Z"}));
  EXPECT_EQ(image->alpha_channel, 3);
}

TEST_F(ExrFile, of_unusual_kinds_is_left_to_the_module) {
  write(file, {{{"R", whole}, {"id", Imf::Channel(Imf::UINT)}}});
  expect_left_to_module();
  write(file, {{{"Y", small}, {"BY", small}, {"RY", small}}});
  expect_left_to_module();

  const Content content({{{"R", whole}, {"G", whole}, {"B", whole}}});
  std::vector<Imf::Header> headers(2, content.header);
  for (std::size_t part = 0; part < 2; ++part)
    headers[part].setName(part == 0 ? "first" : "second"), headers[part].setType(Imf::SCANLINEIMAGE);
  {
    Imf::MultiPartOutputFile out(file.c_str(), headers.data(), 2);
    for (int part = 0; part < 2; ++part) {
      Imf::OutputPart rows(out, part);
      rows.setFrameBuffer(content.frame);
      rows.writePixels(height);
    }
  }
  expect_left_to_module();
  const Result<StoredImage> both = by_module();
  ASSERT_TRUE(both) << both.error();
  EXPECT_EQ(both->parts.size(), 2u);
}

// The library fills as much memory as an entry claims, up to 2 GB, before it reads it.
TEST_F(ExrFile, whose_header_claims_more_than_there_is_is_refused) {
  write(file, {{{"R", whole}, {"G", whole}, {"B", whole}}});
  const std::string content = bytes();
  EXPECT_TRUE(check_exr("a.exr", &content));
  const std::string kind = std::string("compression") + '\0';
  const std::size_t length = content.find(std::string("compression") + '\0' + kind) + 2 * kind.size();
  ASSERT_LT(length, content.size());
  for (const auto& [high, low] : {std::pair{0x7f, 0xff}, {0x00, 0x01}, {0xff, 0xff}}) {
    std::string damaged = content;
    damaged[length + 3] = char(high), damaged[length + 2] = char(low);
    EXPECT_FALSE(check_exr("a.exr", &damaged)) << high;
    const Result<Image> image = read_image("a.exr", damaged);
    ASSERT_FALSE(image) << high;
    EXPECT_NE(image.error().find("larger than the file"), std::string::npos) << image.error();
  }
}

// Whatever is damaged: no crash, and no image of a part of a file.
TEST_F(ExrFile, that_is_damaged_is_left_to_the_module) {
  write(file, {{{"R", whole}, {"G", whole}, {"B", whole}}});
  const std::string content = bytes();
  ASSERT_TRUE(read_exr("a.exr", &content));
  for (std::size_t end = 0; end < content.size(); end += end < 400 ? 1 : 97) {
    const std::string cut = content.substr(0, end);
    EXPECT_FALSE(read_exr("a.exr", &cut)) << end;
  }
  for (std::size_t at = 0; at < 400; ++at) {
    std::string damaged = content;
    damaged[at] = char(damaged[at] ^ 0x55);
    if (const std::optional<StoredImage> image = read_exr("a.exr", &damaged)) {
      EXPECT_LE(image->parts.front().values.size(), largest_sample_count) << at;
    }
  }
}

}  // namespace

}  // namespace montelux
