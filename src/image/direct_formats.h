// PNG and JPEG files of the usual kinds, read and written by libpng and libjpeg alone: they load in a millisecond, the
// module of image formats (image_codec.h) in a quarter of a second.
#pragma once
#include <optional>
#include <string_view>

#include "image/image_codec.h"

namespace montelux {

// The image in the bytes of a file, as the module would give it, except that it has no attributes. None: the bytes are
// of another format, of an unusual kind (palettes, transparent colours, fewer than eight bits, CMYK), or damaged. The
// module then reads the image, or states what is wrong with it.
std::optional<StoredImage> read_directly(std::string_view bytes);

// The bytes of a PNG file that is tagged as sRGB, and of a JPEG file of the quality 95. Not of an empty image.
Result<std::string> encode_png(const DisplayImage& image);
Result<std::string> encode_jpeg(const DisplayImage& image);

}  // namespace montelux
