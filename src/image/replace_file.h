// Files that are either whole or not there.
#pragma once
#include <filesystem>
#include <functional>

#include "math/result.h"

namespace montelux {

// Calls write with the name of a fresh temporary file beside path (same extension), and on success renames it to path,
// so that a reader sees the old file or the new one and never a part. On failure the temporary is removed and path
// stays as it was. Exceptions from write become failures.
Status replace_file(const std::filesystem::path& path,
                    const std::function<Status(const std::string& temporary)>& write);

}  // namespace montelux
