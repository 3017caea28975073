// Whether a PNG file is undamaged according to its own checksums.
#pragma once
#include <string_view>

#include "math/result.h"

namespace montelux {

// States what is wrong with the bytes of a PNG file: truncated chunks, or a wrong checksum (CRC-32, PNG
// specification, 5.3). The library that decodes PNG writes messages about such a file to the standard error output;
// so it never receives one. Bytes that are not a PNG file pass.
Status check_png(std::string_view bytes);

}  // namespace montelux
