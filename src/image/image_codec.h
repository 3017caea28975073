// The part of reading and writing images that needs a large library. It is a separate module because the library and
// its dependencies take a quarter of a second to load: most runs of the program read and write OpenEXR (exr.h), PNG or
// JPEG (direct_formats.h), or no image.
#pragma once
#include <string>
#include <vector>

#include "image/image_file.h"

namespace montelux {

// A file as stored, except for its samples, which are floats: integers map to [0, 1], not decoded.
struct StoredImage {
  std::vector<PixelBuffer> parts;       // at least one; from a multi-part EXR those with the size of the first
  std::vector<std::string> part_names;  // one per part
  SampleType stored = SampleType::float32;
  int alpha_channel = -1;  // of the first part; -1: none
  std::vector<Attribute> attributes;
};

// The maximum ratio of decoded bytes to file bytes: deflate reaches 1032 (zlib's documentation), run lengths and
// discrete cosines less; the others have no known bound.
inline constexpr double deflate_packing = 1032, unknown_packing = 1 << 18;
// Whether a file of this size can contain what its header states. Small images are not checked.
constexpr bool may_contain(double file_bytes, double packing, double stated_bytes) {
  constexpr double small = 1 << 26;
  return stated_bytes <= small || stated_bytes <= packing * file_bytes;
}

// Interleaved samples to be encoded.
struct SamplesToEncode {
  int width = 0, height = 0, channel_count = 3;
  const float* floats = nullptr;
};

// The interface of the module. May throw what the library throws.
struct ImageCodec {
  // Reads the file of this name, or `bytes` if it is not null. The extension of the name selects the format.
  Result<StoredImage> (*read)(const std::string& name, const std::string* bytes);
  // The bytes of a file in the format of the name's extension.
  Result<std::string> (*encode)(const std::string& name, const SamplesToEncode& samples);
};

// Loads the module on the first call. Fails if it is found neither next to the program nor where it was built.
Result<const ImageCodec*> image_codec();

}  // namespace montelux
