// Files that are written completely or not at all.
#pragma once
#include <filesystem>
#include <string_view>

#include "math/result.h"

namespace montelux {

// The prefix of the names of temporary files. They are open as long as they exist, so that code that ends the process
// finds them among its open files.
inline constexpr std::string_view temporary_prefix = ".montelux-";

// Writes the bytes to a file and checks every write. A regular file is replaced atomically by a temporary file in the
// same folder whose bytes are on the disk by then: a reader sees the old file or the new one; on failure the old one
// remains. A new file has the mode given by the umask; a replaced one keeps mode and, where possible, owner and group.
// Symbolic links are followed. A FIFO, a device or an open descriptor (/dev/stdout) is written to directly.
Status write_file(const std::filesystem::path& path, std::string_view bytes);
// The same of bytes in two parts.
Status write_file(const std::filesystem::path& path, std::string_view first, std::string_view second);

// Whether write_file() is likely to succeed, for a check before long work: creates the temporary file and removes it.
// A FIFO or a device is not opened.
Status check_output_file(const std::filesystem::path& path);

// The same for files in a folder, which is created if it is missing.
Status check_output_folder(const std::filesystem::path& folder);

}  // namespace montelux
