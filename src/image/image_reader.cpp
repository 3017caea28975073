#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <new>
#include <stdexcept>
#include <system_error>

#include "image/direct_formats.h"
#include "image/exr.h"
#include "image/image_codec.h"
#include "image/image_file.h"
#include "image/png_check.h"

namespace montelux {
namespace {

bool is_integer(SampleType type) { return type == SampleType::uint8 || type == SampleType::uint16; }

// Appends the further parts of the file as layers; a part name that equals the prefix of its channels is not repeated.
void append_parts(const StoredImage& file, PixelBuffer& pixels) {
  for (std::size_t part = 1; part < file.parts.size(); ++part) {
    const bool prefixed = file.parts[part].channels.front().find('.') != std::string::npos;
    append_layer(pixels, prefixed ? "" : file.part_names[part], file.parts[part]);
  }
}

void decode_colors(PixelBuffer& pixels, const ColorEncoding& encoding, int alpha) {
  if (encoding.kind == ColorEncoding::Kind::linear) return;
  int c = 0;
  for (float& value : pixels.values) {
    if (c != alpha) value = decode(encoding, value);
    if (++c == pixels.channel_count()) c = 0;
  }
}

// A name with an extension by which the library recognises the format of a file in memory.
std::optional<std::string> name_by_content(const std::string& bytes) {
  using namespace std::string_view_literals;
  constexpr std::array<std::pair<std::string_view, const char*>, 6> beginnings{{{"\x89PNG"sv, "image.png"},
                                                                                {"\xff\xd8\xff"sv, "image.jpg"},
                                                                                {exr_magic, "image.exr"},
                                                                                {"#?"sv, "image.hdr"},
                                                                                {"RIFF"sv, "image.webp"},
                                                                                {"GIF8"sv, "image.gif"}}};
  for (const auto& [beginning, name] : beginnings)
    if (bytes.starts_with(beginning)) return name;
  return std::nullopt;
}

// The bytes of a file that begins like a PNG or JPEG file; none of others.
std::string bytes_of_usual_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(8, '\0');
  if (!file.read(bytes.data(), 8) || !(bytes.starts_with("\x89PNG") || bytes.starts_with("\xff\xd8\xff"))) return {};
  bytes.append(std::istreambuf_iterator<char>(file), {});
  return bytes;
}

// As stored: directly where that is possible, else by the module. `bytes`: null for a file.
Result<StoredImage> read_stored(const std::string& name, const std::string* bytes) {
  if (const Status whole = check_exr(name, bytes); !whole) return whole.failure();
  if (std::optional<StoredImage> exr = read_exr(name, bytes)) return *std::move(exr);
  const std::string of_file = bytes ? std::string() : bytes_of_usual_file(name);
  const std::string& begun = bytes ? *bytes : of_file;
  if (const Status whole = check_png(begun); !whole) return whole.failure();
  if (std::optional<StoredImage> direct = read_directly(begun)) return *std::move(direct);
  const Result<const ImageCodec*> codec = image_codec();
  if (!codec) return codec.failure();
  return (*codec)->read(name, bytes);
}

// Either a file, or bytes in memory.
Result<Image> read_open(const std::filesystem::path& path, const std::string* bytes,
                        std::optional<ColorEncoding> encoding) {
  std::optional<std::string> name = path.string();
  if (bytes) {
    name = name_by_content(*bytes);
    if (!name) return Failure{"unknown or corrupt format"};
  } else {
    std::error_code error;
    std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) return Failure{"no such file"};
    if (std::filesystem::is_directory(status)) return Failure{"it is a directory"};
    // Reading a FIFO may never end, and reading a device does not.
    if (!std::filesystem::is_regular_file(status)) return Failure{"it is not a regular file"};
  }

  Result<StoredImage> read = read_stored(*name, bytes);
  if (!read) return read.failure();
  StoredImage& file = *read;
  Image image{std::move(file.parts.front()), file.stored, {}, std::move(file.attributes)};
  image.encoding =
      encoding.value_or(is_integer(image.stored) ? ColorEncoding{ColorEncoding::Kind::srgb, 1.0f} : ColorEncoding{});
  decode_colors(image.pixels, image.encoding, file.alpha_channel);
  append_parts(file, image.pixels);
  return image;
}

Result<Image> read_safely(const std::filesystem::path& path, const std::string* bytes,
                          std::optional<ColorEncoding> encoding) {
  std::string prefix = "cannot read image '" + path.string() + "': ";
  try {
    Result<Image> image = read_open(path, bytes, encoding);
    if (image) return image;
    return Failure{prefix + (image.error().empty() ? "unknown or corrupt format" : image.error())};
  } catch (const std::bad_alloc&) {
    return Failure{prefix + "it is damaged, or does not fit in memory"};
  } catch (const std::length_error&) {
    return Failure{prefix + "it is damaged, or does not fit in memory"};
  } catch (const std::exception& e) {
    return Failure{prefix + e.what()};
  }
}

}  // namespace

Result<Image> read_image(const std::filesystem::path& path, std::optional<ColorEncoding> encoding) {
  return read_safely(path, nullptr, encoding);
}

Result<Image> read_image(const std::filesystem::path& name, const std::string& bytes,
                         std::optional<ColorEncoding> encoding) {
  return read_safely(name, &bytes, encoding);
}

}  // namespace montelux
