// The module of image formats: OpenImageIO and its dependencies.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "image/image_codec.h"

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
           std::to_string(spec.nchannels) + " samples exceeds the limit";
  return {};
}

double max_packing(std::string_view format, std::string_view compression) {
  if (format == "openexr") return compression.starts_with("dwa") ? unknown_packing : deflate_packing;
  constexpr std::array<std::string_view, 6> simple{"png", "bmp", "targa", "pnm", "jpeg", "gif"};
  return std::find(simple.begin(), simple.end(), format) == simple.end() ? unknown_packing : 4 * deflate_packing;
}

bool is_plausible(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec, std::uintmax_t file_size) {
  const double packing = max_packing(input.format_name(), spec.get_string_attribute("compression"));
  return may_contain(double(file_size), packing, double(std::max(spec.image_bytes(true), spec.tile_bytes(true))));
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
    return Failure{"its header states " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                   " pixels, which do not fit in " + std::to_string(source.size) + " bytes: it is damaged"};
  PixelBuffer pixels{spec.width, spec.height, spec.channelnames, {}};
  pixels.values.resize(pixels.pixel_count() * spec.channelnames.size());
  if (!input.read_image(part, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.values.data()))
    return Failure{input.geterror()};
  return pixels;
}

// Appends the further parts that have the size of the first.
Status read_further_parts(const Source& source, StoredImage& image) {
  OIIO::ImageInput& input = source.input;
  const int width = image.parts.front().width, height = image.parts.front().height;
  std::size_t total = image.parts.front().values.size();
  for (int part = 1; input.seek_subimage(part, 0); ++part) {
    OIIO::ImageSpec spec = input.spec(part);
    if (spec.width != width || spec.height != height) continue;
    total += std::size_t(width) * std::size_t(height) * std::size_t(std::max(spec.nchannels, 0));
    if (total > largest_sample_count) return Failure{"its parts together exceed the limit"};
    Result<PixelBuffer> added = read_part(source, part);
    if (!added) return added.failure();
    image.part_names.emplace_back(spec.get_string_attribute("oiio:subimagename", "part" + std::to_string(part)));
    image.parts.push_back(*std::move(added));
  }
  return Done{};
}

Result<StoredImage> read(const std::string& name, const std::string* bytes) {
  OIIO::ImageSpec wishes;
  wishes["oiio:UnassociatedAlpha"] = 1;
  std::optional<OIIO::Filesystem::IOMemReader> memory;
  if (bytes) {
    OIIO::Filesystem::IOProxy* proxy = &memory.emplace(bytes->data(), bytes->size());
    wishes.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  }
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(name, &wishes);
  if (!input) return Failure{OIIO::geterror()};

  const OIIO::ImageSpec spec = input->spec();
  StoredImage image{{}, {std::string()}, sample_type(spec.format), spec.alpha_channel, header(spec)};
  const Source source{*input, bytes ? bytes->size() : std::filesystem::file_size(name)};
  Result<PixelBuffer> pixels = read_part(source, 0);
  if (!pixels) return pixels.failure();
  image.parts.push_back(*std::move(pixels));
  if (Status parts = read_further_parts(source, image); !parts) return parts.failure();
  return image;
}

// Selects the codec by the file extension.
Result<std::string> encode(const std::string& name, const SamplesToEncode& samples) {
  const OIIO::ImageSpec spec(samples.width, samples.height, samples.channel_count, OIIO::TypeFloat);
  std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name);
  if (!output) return Failure{OIIO::geterror()};
  OIIO::Filesystem::IOVecOutput memory;
  const bool good = output->set_ioproxy(&memory) && output->open(name, spec) &&
                    output->write_image(spec.format, samples.floats) && output->close();
  if (!good) return Failure{output->geterror()};
  return std::string(memory.buffer().begin(), memory.buffer().end());
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const ImageCodec montelux_image_codec{read, encode};

}  // namespace montelux
