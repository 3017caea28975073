// OpenEXR files of the usual kind, read by the library that also writes them: it loads in milliseconds, the module of
// image formats (image_codec.h) in a quarter of a second.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "image/image_codec.h"

namespace montelux {

// With which every such file begins.
inline constexpr std::string_view exr_magic = "\x76\x2f\x31\x01";

// The image in a file, or in `bytes` if they are not null, as the module would give it, except that the entries of its
// header keep their names, and that the channels of a layer are in the order red, green, blue, alpha, the others by
// name. None: it is of another format, has several parts, volumes of samples, channels of integers, of chroma or of
// less than the full resolution, or is damaged. The module then reads it, or states what is wrong with it.
std::optional<StoredImage> read_exr(const std::string& name, const std::string* bytes);

// Fails where an entry of the header claims more bytes than the file has: the library would fill so many before it
// reads them. Other formats, and other faults, pass.
Status check_exr(const std::string& name, const std::string* bytes);

// How many threads work on a file: at most `stated` (0: all of the machine), and 8, since for each of them the library
// stores rows that wait to be coded, and rows that are.
int exr_threads(int stated);

}  // namespace montelux
