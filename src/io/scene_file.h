// Scene files in all supported formats.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "io/read_result.h"

namespace montelux {

// File extensions of scene files, with the dot.
std::span<const std::string_view> scene_file_endings();

// Reads a scene in the format given by the extension: .pbrt and .pbrt.gz by read_pbrt(), .gltf and .glb by read_gltf().
// Any other extension is an error that names the valid ones.
ReadResult read_scene(const std::string& path, const ReadOptions& options = {});

}  // namespace montelux
