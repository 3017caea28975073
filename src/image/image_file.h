// Image files: reading of whatever OpenImageIO understands, and writing of EXR, Radiance HDR, PFM, PNG and JPEG.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "color/transfer.h"
#include "image/pixel_buffer.h"
#include "math/result.h"

namespace montelux {

// How a file stores its samples.
enum class SampleType { uint8, uint16, half, float32 };

// One typed entry of a file's header.
struct Attribute {
  std::string name;
  std::variant<std::string, std::int32_t, float, double> value;

  friend bool operator==(const Attribute&, const Attribute&) = default;
};

// An image file in memory. The pixels are linear; encoding states how the colour channels were stored, and stored the
// width of a sample (8-bit integers are decoded exactly once, here).
struct Image {
  PixelBuffer pixels;
  SampleType stored = SampleType::float32;
  ColorEncoding encoding;
  std::vector<Attribute> attributes;
};

// The most samples (pixels times channels) that a file may hold.
inline constexpr std::size_t largest_sample_count = std::size_t(1) << 30;

// Reads any image file. Without an encoding, integers are taken as sRGB and floating-point samples as linear; alpha is
// always linear and is not multiplied into the colour. All parts of a multi-part EXR whose size is that of the first
// are appended as layers. Fails for missing, corrupt and absurdly large files; never throws.
Result<Image> read_image(const std::filesystem::path& path, std::optional<ColorEncoding> encoding = std::nullopt);

// The same for a file in memory; messages call it by `name`.
Result<Image> read_image(const std::filesystem::path& name, const std::string& bytes,
                         std::optional<ColorEncoding> encoding = std::nullopt);

// Header entries of an EXR and the channels to be stored as half; the others are 32-bit floats.
struct ExrOptions {
  std::vector<Attribute> attributes;
  std::vector<std::string> half_channels;
  int threads = 1;  // that compress it, at most; 0: all of the machine
};

// The bytes of a file with linear values, by the extension of path: .exr with every channel under its own name, .hdr
// and .pfm with the colour alone. The same arguments give the same bytes. Never throws; failures name the path.
Result<std::string> encode_image(const std::filesystem::path& path, const PixelBuffer& image,
                                 const ExrOptions& options = {});

// A picture that is made some rows at a time, so that all of its channels are never in memory together.
struct ImageRows {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::function<PixelBuffer(int first, int count)> rows;  // those rows, counted from the top
};

// So many rows are queried at a time.
int exr_rows_together(int threads);
// The bytes of an .exr, equal to those of the same picture in one buffer. Never throws; failures name the path.
Result<std::string> encode_exr(const std::filesystem::path& path, const ImageRows& image,
                               const ExrOptions& options = {});

// Writes them as write_file() does; never throws.
Status write_image(const std::filesystem::path& path, const PixelBuffer& image, const ExrOptions& options = {});
Status write_exr(const std::filesystem::path& path, const ImageRows& image, const ExrOptions& options = {});

// An 8-bit picture that is ready for display: 1 (gray) or 3 (RGB) interleaved channels, the top row first.
struct DisplayImage {
  int width = 0;
  int height = 0;
  int channel_count = 3;
  std::vector<std::uint8_t> values;
};

// The bytes of a .png or .jpg. Never throws; failures name the path.
Result<std::string> encode_image(const std::filesystem::path& path, const DisplayImage& image);

// Writes .png or .jpg, as write_file() does; never throws.
Status write_image(const std::filesystem::path& path, const DisplayImage& image);

// The header entry capDate for the time in the environment variable SOURCE_DATE_EPOCH; nothing if it is not set. Files
// carry no other time.
std::optional<Attribute> date_attribute();

}  // namespace montelux
