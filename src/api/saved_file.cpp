#include "api/saved_file.h"

#include <fmt/format.h>

#include <fstream>

#include "api/images.h"
#include "io/scene_file.h"

namespace montelux {

namespace fs = std::filesystem;

bool begins_as(const fs::path& file, const SavedFormat& format) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return false;
  std::string begin(64, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(begin.data(), std::streamsize(begin.size()));
  return begin.find(fmt::format("\"{}\"", format.name)) != std::string::npos;
}

Status check_saved_target(const fs::path& file, const SavedFormat& format) {
  if (is_picture_name(file) || scene_format_of(file.string()))
    return Failure{fmt::format("cannot write '{}': a saved {} needs another ending than a {}", file.string(),
                               format.what, is_picture_name(file) ? "picture" : "scene")};
  std::error_code ignored;
  if (fs::is_regular_file(file, ignored) && !fs::is_empty(file, ignored) && !begins_as(file, format))
    return Failure{fmt::format("cannot write '{}': this file exists and is not a saved {}, so it is not replaced",
                               file.string(), format.what)};
  return check_output_file(file);
}

}  // namespace montelux
