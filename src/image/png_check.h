// Whether a PNG file is whole, by its own checksums.
#pragma once
#include <string_view>

#include "math/result.h"

namespace montelux {

// Says what is wrong with the bytes of a PNG file: chunks that are cut off, or whose checksum (CRC-32, PNG
// specification, 5.3) is not theirs. The library that decodes such a file writes about it to the standard error output;
// so it is not given one. Bytes that are no PNG file pass.
Status check_png(std::string_view bytes);

}  // namespace montelux
