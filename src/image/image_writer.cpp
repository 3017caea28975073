#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <fstream>

#include "image/image_file.h"
#include "image/replace_file.h"

namespace montelux {
namespace {

void insert(Imf::Header& header, const Attribute& attribute) {
  const std::string& name = attribute.name;
  std::visit(
      [&](const auto& value) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, std::string>) header.insert(name, Imf::StringAttribute(value));
        if constexpr (std::is_same_v<T, std::int32_t>) header.insert(name, Imf::IntAttribute(value));
        if constexpr (std::is_same_v<T, float>) header.insert(name, Imf::FloatAttribute(value));
        if constexpr (std::is_same_v<T, double>) header.insert(name, Imf::DoubleAttribute(value));
      },
      attribute.value);
}

// One plane of halves; finite values beyond the range of a half are held at its end.
std::vector<half> to_half(const PixelBuffer& image, int channel) {
  std::vector<half> plane;
  plane.reserve(image.pixel_count());
  for (std::size_t i = std::size_t(channel); i < image.values.size(); i += image.channels.size()) {
    float value = image.values[i];
    plane.emplace_back(is_finite(value) ? std::clamp(value, -65504.0f, 65504.0f) : value);
  }
  return plane;
}

Status write_exr(const std::string& file, const PixelBuffer& image, const ExrOptions& options) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const Attribute& attribute : options.attributes) insert(header, attribute);

  Imf::FrameBuffer frame;
  std::vector<std::vector<half>> planes;
  planes.reserve(image.channels.size());
  std::size_t stride = sizeof(float) * image.channels.size();
  for (int c = 0; c < image.channel_count(); ++c) {
    const std::string& name = image.channels[std::size_t(c)];
    const std::vector<std::string>& halves = options.half_channels;
    if (std::find(halves.begin(), halves.end(), name) != halves.end()) {
      header.channels().insert(name, Imf::Channel(Imf::HALF));
      std::vector<half>& plane = planes.emplace_back(to_half(image, c));
      frame.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(plane.data()), sizeof(half),
                                    sizeof(half) * std::size_t(image.width)));
    } else {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      // The library takes a pointer to mutable data but only reads it when writing a file.
      char* data = reinterpret_cast<char*>(const_cast<float*>(image.values.data() + c));
      frame.insert(name, Imf::Slice(Imf::FLOAT, data, stride, stride * std::size_t(image.width)));
    }
  }
  Imf::OutputFile output(file.c_str(), header);
  output.setFrameBuffer(frame);
  output.writePixels(image.height);
  return Done{};
}

template <class T>
Status write_by_library(const std::string& file, const OIIO::ImageSpec& spec, const T* values) {
  std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(file);
  if (!output) return Failure{OIIO::geterror()};
  bool good = output->open(file, spec) && output->write_image(spec.format, values) && output->close();
  if (!good) return Failure{output->geterror()};
  return Done{};
}

// The colour channels alone, interleaved.
std::vector<float> colors_of(const PixelBuffer& image) {
  std::vector<float> colors;
  colors.reserve(image.pixel_count() * 3);
  std::array<int, 3> rgb = rgb_channels(image);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (float value : rgb_at(image, rgb, x, y).c) colors.push_back(value);
  return colors;
}

Status write_hdr(const std::string& file, const PixelBuffer& image) {
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeFloat);
  return write_by_library(file, spec, colors_of(image).data());
}

// Portable float map: a text header whose negative scale means little-endian, then the rows from the bottom up.
Status write_pfm(const std::string& file, const PixelBuffer& image) {
  static_assert(std::endian::native == std::endian::little);
  std::vector<float> colors = colors_of(image);
  std::ofstream out(file, std::ios::binary);
  out << "PF\n" << image.width << ' ' << image.height << "\n-1.0\n";
  std::size_t row = 3 * std::size_t(image.width);
  for (int y = image.height - 1; y >= 0; --y)
    out.write(reinterpret_cast<const char*>(&colors[std::size_t(y) * row]), std::streamsize(row * sizeof(float)));
  out.close();
  if (!out) return Failure{"the disk is full or the file cannot be written"};
  return Done{};
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

}  // namespace

Status write_image(const std::filesystem::path& path, const PixelBuffer& image, const ExrOptions& options) {
  std::string extension = lower_extension(path);
  if (image.width <= 0 || image.height <= 0 || image.channels.empty())
    return Failure{"cannot write '" + path.string() + "': the image is empty"};
  if (extension == ".exr")
    return replace_file(path, [&](const std::string& file) { return write_exr(file, image, options); });
  if (extension == ".hdr") return replace_file(path, [&](const std::string& file) { return write_hdr(file, image); });
  if (extension == ".pfm") return replace_file(path, [&](const std::string& file) { return write_pfm(file, image); });
  return Failure{"cannot write '" + path.string() + "': linear values go to .exr, .hdr or .pfm files"};
}

Status write_image(const std::filesystem::path& path, const DisplayImage& image) {
  if (image.width <= 0 || image.height <= 0 || image.values.empty())
    return Failure{"cannot write '" + path.string() + "': the image is empty"};
  OIIO::ImageSpec spec(image.width, image.height, image.channel_count, OIIO::TypeUInt8);
  spec["oiio:ColorSpace"] = "sRGB";
  spec["CompressionQuality"] = 95;
  return replace_file(path, [&](const std::string& file) { return write_by_library(file, spec, image.values.data()); });
}

std::optional<Attribute> date_attribute() {
  const char* text = std::getenv("SOURCE_DATE_EPOCH");
  if (!text) return std::nullopt;
  std::string_view digits = text;
  std::int64_t seconds = 0;
  auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seconds);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  std::time_t time = std::time_t(seconds);
  std::tm parts{};
  if (!gmtime_r(&time, &parts)) return std::nullopt;
  char date[32];
  std::strftime(date, sizeof date, "%Y:%m:%d %H:%M:%S", &parts);
  return Attribute{"capDate", std::string(date)};
}

}  // namespace montelux
