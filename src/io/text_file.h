// Files read whole, compressed or not.
#pragma once
#include <string>
#include <string_view>

#include "math/result.h"

namespace montelux {

// The bytes of a regular file; one that gzip has compressed (whatever its name) is unpacked. Fails where the file is
// missing, is no regular file (a FIFO may never end, nor does /dev/zero), is damaged, or has more than 8 GiB; and where
// it unpacks to more than that, or to more than 64 MiB and 256 times its size.
Result<std::string> read_whole_file(const std::string& path);

// `name` as it is to be opened: an absolute path stays, another one starts at `folder`.
std::string resolve_path(const std::string& folder, const std::string& name);

// A URI's text with what stands for bytes as those bytes: "%20" becomes a space (RFC 3986, 2.1). Other text stays.
std::string without_escapes(std::string_view text);

// The text behind a UTF-8 byte-order mark, with which some editors begin a file; other text as it is.
std::string_view without_byte_order_mark(std::string_view text);

// Whether a regular file of this path can be seen.
bool is_regular_file(const std::string& path);

// Text from a user's file made fit to be printed in a message: control characters and what is no UTF-8 become
// `instead`, a byte for a byte.
std::string without_control(std::string_view text, char instead);
// Text in which every byte that is no part of UTF-8 stands as "\xHH": the file names of Linux are any bytes, JSON is
// UTF-8. Other text stays.
std::string as_utf8(std::string_view text);
bool is_utf8(std::string_view text);
// As without_control() by '?', and long text is cut.
std::string printable(std::string_view text);

}  // namespace montelux
