// The part of reading and writing images that needs a large library. It is a module of its own, since that library and
// all that it depends on take a quarter of a second to load: most runs of the program read and write OpenEXR alone, or
// no image.
#pragma once
#include <string>
#include <vector>

#include "image/image_file.h"

namespace montelux {

// A file as it is stored, but for its samples, which are floats: integers from 0 to 1, not decoded.
struct StoredImage {
  std::vector<PixelBuffer> parts;       // one at least; of an EXR of several parts those of the first one's size
  std::vector<std::string> part_names;  // as many
  SampleType stored = SampleType::float32;
  int alpha_channel = -1;  // of the first part; -1: none
  std::vector<Attribute> attributes;
};

// Interleaved samples that are to be encoded: either floats or bytes, the other is empty.
struct SamplesToEncode {
  int width = 0, height = 0, channel_count = 3;
  const float* floats = nullptr;
  const std::uint8_t* bytes = nullptr;  // sRGB
};

// What the module offers. May throw what the library throws.
struct ImageCodec {
  // The file of this name, or where `bytes` is not null these, whose format the name's ending tells.
  Result<StoredImage> (*read)(const std::string& name, const std::string* bytes);
  // The bytes of a file of the format of the name's ending.
  Result<std::string> (*encode)(const std::string& name, const SamplesToEncode& samples);
};

// Loads the module when it is called first. Fails where the module is not beside the program, nor where it was built.
Result<const ImageCodec*> image_codec();

}  // namespace montelux
