#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <system_error>

#include "image/image_file.h"

namespace montelux {
namespace {

SampleType sample_type(OIIO::TypeDesc type) {
  switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
    case OIIO::TypeDesc::INT8:
      return SampleType::uint8;
    case OIIO::TypeDesc::UINT16:
    case OIIO::TypeDesc::INT16:
      return SampleType::uint16;
    case OIIO::TypeDesc::HALF:
      return SampleType::half;
    default:
      return SampleType::float32;
  }
}

bool is_integer(SampleType type) { return type == SampleType::uint8 || type == SampleType::uint16; }

// The header entries of the types that an Attribute can hold.
std::vector<Attribute> header(const OIIO::ImageSpec& spec) {
  std::vector<Attribute> attributes;
  for (const OIIO::ParamValue& entry : spec.extra_attribs) {
    std::string name = entry.name().string();
    if (entry.type() == OIIO::TypeString)
      attributes.push_back({name, entry.get_string()});
    else if (entry.type() == OIIO::TypeInt)
      attributes.push_back({name, std::int32_t(entry.get_int())});
    else if (entry.type() == OIIO::TypeFloat)
      attributes.push_back({name, entry.get_float()});
    else if (entry.type() == OIIO::TypeDesc(OIIO::TypeDesc::DOUBLE))
      attributes.push_back({name, *static_cast<const double*>(entry.data())});
  }
  return attributes;
}

std::string size_complaint(const OIIO::ImageSpec& spec) {
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) return "the image is empty";
  if (spec.depth > 1) return "it is a volume, not an image";
  if (spec.deep) return "deep images are not supported";
  std::uint64_t samples = std::uint64_t(spec.width) * std::uint64_t(spec.height);
  if (samples > largest_sample_count || samples * std::uint64_t(spec.nchannels) > largest_sample_count)
    return "its size of " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " x " +
           std::to_string(spec.nchannels) + " samples is beyond all reason";
  return {};
}

// How many bytes of samples a byte of a file stands for at the most: deflate gains 1032 (zlib's documentation), run
// lengths and discrete cosines less; the others have no known bound.
double max_packing(std::string_view format, std::string_view compression) {
  constexpr double deflate = 1032, unknown = 1 << 18;
  if (format == "openexr") return compression.starts_with("dwa") ? unknown : deflate;
  constexpr std::array<std::string_view, 6> simple{"png", "bmp", "targa", "pnm", "jpeg", "gif"};
  return std::find(simple.begin(), simple.end(), format) == simple.end() ? unknown : 4 * deflate;
}

// Whether a file of this size can hold what its header promises. Small pictures are not looked at.
bool is_plausible(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec, std::uintmax_t file_size) {
  constexpr std::uint64_t small = std::uint64_t(64) << 20;
  const std::uint64_t bytes = spec.image_bytes(true), tile = spec.tile_bytes(true);
  const std::string_view compression = spec.get_string_attribute("compression");
  const double most = double(file_size) * max_packing(input.format_name(), compression);
  return std::max(bytes, tile) <= small || double(std::max(bytes, tile)) <= most;
}

// A file that is being read: by name, or in memory.
struct Source {
  OIIO::ImageInput& input;
  std::uintmax_t size;  // in bytes
};

Result<PixelBuffer> read_part(const Source& source, int part) {
  OIIO::ImageInput& input = source.input;
  OIIO::ImageSpec spec = input.spec(part);
  std::string complaint = size_complaint(spec);
  if (!complaint.empty()) return Failure{complaint};
  if (!is_plausible(input, spec, source.size))
    return Failure{"its header promises " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                   " pixels, which do not fit in " + std::to_string(source.size) + " bytes: it is damaged"};
  PixelBuffer pixels = make_pixel_buffer(spec.width, spec.height, spec.channelnames);
  if (!input.read_image(part, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.values.data()))
    return Failure{input.geterror()};
  return pixels;
}

// Appends the further parts of the file as layers; a part that is named like its channels' prefix is not named twice.
Status read_further_parts(const Source& source, PixelBuffer& pixels) {
  OIIO::ImageInput& input = source.input;
  for (int part = 1; input.seek_subimage(part, 0); ++part) {
    OIIO::ImageSpec spec = input.spec(part);
    if (spec.width != pixels.width || spec.height != pixels.height) continue;
    std::size_t total = pixels.pixel_count() * (pixels.channels.size() + std::size_t(std::max(spec.nchannels, 0)));
    if (total > largest_sample_count) return Failure{"its parts together are beyond all reason"};
    Result<PixelBuffer> added = read_part(source, part);
    if (!added) return added.failure();
    std::string name(spec.get_string_attribute("oiio:subimagename", "part" + std::to_string(part)));
    bool prefixed = added->channels.front().find('.') != std::string::npos;
    append_layer(pixels, prefixed ? "" : name, *added);
  }
  return Done{};
}

void decode_colors(PixelBuffer& pixels, const ColorEncoding& encoding, int alpha) {
  if (encoding.kind == ColorEncoding::Kind::linear) return;
  int c = 0;
  for (float& value : pixels.values) {
    if (c != alpha) value = decode(encoding, value);
    if (++c == pixels.channel_count()) c = 0;
  }
}

// A name by whose ending the library finds the format of a file that is in memory.
std::optional<std::string> name_by_content(const std::string& bytes) {
  using namespace std::string_view_literals;
  constexpr std::array<std::pair<std::string_view, const char*>, 6> beginnings{{{"\x89PNG"sv, "image.png"},
                                                                                {"\xff\xd8\xff"sv, "image.jpg"},
                                                                                {"\x76\x2f\x31\x01"sv, "image.exr"},
                                                                                {"#?"sv, "image.hdr"},
                                                                                {"RIFF"sv, "image.webp"},
                                                                                {"GIF8"sv, "image.gif"}}};
  for (const auto& [beginning, name] : beginnings)
    if (bytes.starts_with(beginning)) return name;
  return std::nullopt;
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
    // A FIFO may never end, and a device does not.
    if (!std::filesystem::is_regular_file(status)) return Failure{"it is not a regular file"};
  }

  OIIO::ImageSpec wishes;
  wishes["oiio:UnassociatedAlpha"] = 1;
  std::optional<OIIO::Filesystem::IOMemReader> memory;
  if (bytes) {
    OIIO::Filesystem::IOProxy* proxy = &memory.emplace(bytes->data(), bytes->size());
    wishes.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  }
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(*name, &wishes);
  if (!input) return Failure{OIIO::geterror()};

  const OIIO::ImageSpec spec = input->spec();
  Image image{{}, sample_type(spec.format), {}, header(spec)};
  image.encoding =
      encoding.value_or(is_integer(image.stored) ? ColorEncoding{ColorEncoding::Kind::srgb, 1.0f} : ColorEncoding{});
  const Source source{*input, bytes ? bytes->size() : std::filesystem::file_size(path)};
  Result<PixelBuffer> pixels = read_part(source, 0);
  if (!pixels) return pixels.failure();
  image.pixels = std::move(pixels).value();
  decode_colors(image.pixels, image.encoding, spec.alpha_channel);
  Status parts = read_further_parts(source, image.pixels);
  if (!parts) return parts.failure();
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
