// Files that are written whole or not at all.
#pragma once
#include <filesystem>
#include <string_view>

#include "math/result.h"

namespace montelux {

// The names of temporary files begin with this. They are open as long as they exist, so that whoever ends the process
// finds them among its open files.
inline constexpr std::string_view temporary_prefix = ".montelux-";

// Writes the bytes to a file; every write is checked. A regular file is replaced in one step by a temporary beside it,
// whose bytes are on the disk by then: a reader sees the old file or the new one, and on failure the old one stays. A
// new file has the mode that the umask leaves, a replaced one keeps mode and, where the system allows it, owner and
// group. A symbolic link is followed. A FIFO, a device or an open descriptor (/dev/stdout) is written to.
Status write_file(const std::filesystem::path& path, std::string_view bytes);

// Whether write_file() can be expected to succeed, to be called before long work: makes the temporary and removes it.
// A FIFO or a device is not opened.
Status check_output_file(const std::filesystem::path& path);

// The same for files in a folder, which is made where it is missing.
Status check_output_folder(const std::filesystem::path& folder);

}  // namespace montelux
