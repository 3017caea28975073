// Files read completely, compressed or not.
#pragma once
#include <string>
#include <string_view>

#include "math/result.h"

namespace montelux {

// The bytes of a regular file; one that is compressed by gzip (with any name) is decompressed. Fails if the file is
// missing, is not a regular file (a FIFO may never end, nor does /dev/zero), is damaged, or has more than 8 GiB; and if
// it decompresses to more than that, or to more than 64 MiB and 256 times its size.
Result<std::string> read_whole_file(const std::string& path);

// The path under which `name` is opened: an absolute path is unchanged, any other one is relative to `folder`.
std::string resolve_path(const std::string& folder, const std::string& name);

// The text of a URI with its escapes resolved: "%20" becomes a space (RFC 3986, 2.1). Other text is unchanged.
std::string without_escapes(std::string_view text);

// The text without the UTF-8 byte-order mark with which some editors begin a file; other text is unchanged.
std::string_view without_byte_order_mark(std::string_view text);

// Whether a regular file with this path exists and is accessible.
bool is_regular_file(const std::string& path);

// Text from a user's file made safe for a message: control characters and bytes that are not UTF-8 become
// `instead`, byte by byte.
std::string without_control(std::string_view text, char instead);
// Text in which every byte that is not part of UTF-8 is written as "\xHH": file names on Linux are arbitrary bytes,
// JSON is UTF-8. Other text is unchanged.
std::string as_utf8(std::string_view text);
bool is_utf8(std::string_view text);
// Like without_control() with '?'; long text is truncated.
std::string printable(std::string_view text);

}  // namespace montelux
