// Scene files in all supported formats.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/read_result.h"

namespace montelux {

// One scene format: a row of the table of formats.
struct SceneFormat {
  std::string_view name;
  std::vector<std::string_view> extensions;  // with the dot, in lower case; file names may use either case
  bool has_choices = false;                  // a file may contain several cameras and animations
  ReadResult (*read)(const std::string& path, const ReadOptions& options);
  // The part of the content of a file (decompressed) that names the other files of the scene.
  std::string (*naming_text)(const std::string& content);
};
std::span<const SceneFormat> scene_formats();
// By the extension; null for other extensions.
const SceneFormat* scene_format_of(const std::string& path);
// ".pbrt, .pbrt.gz, ...".
std::string scene_file_extensions();

// Reads a scene in the format given by the extension. Any other extension is an error that names the valid ones.
ReadResult read_scene(const std::string& path, const ReadOptions& options = {});

}  // namespace montelux
