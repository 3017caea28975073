// Scene files of every format that Montelux reads.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "io/read_result.h"

namespace montelux {

// Endings of the names of scene files, with the dot.
std::span<const std::string_view> scene_file_endings();

// Reads a scene by the ending of its name: .pbrt and .pbrt.gz as read_pbrt(), .gltf and .glb as read_gltf(). Any other
// ending is an error that names the valid ones.
ReadResult read_scene(const std::string& path, const ReadOptions& options = {});

}  // namespace montelux
