// Scenes in the text format of pbrt-v4.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "parameter/diagnostic.h"
#include "scene/description.h"

namespace montelux {

struct ReadOptions {
  // Unknown parameters, and what Montelux cannot do yet (motion, media, some materials), are warnings instead of
  // errors; stand-ins take their places.
  bool lenient = false;
};

// A scene, or no scene where an error was found. Diagnostics may hold warnings and notes beside a scene.
struct ReadResult {
  std::optional<SceneDesc> scene;
  Diagnostics diagnostics;
};

// Reads a file (.pbrt, also compressed by gzip) with all that it includes; meshes are read, images only looked for.
// All errors are collected in one run, at most 50 a file.
ReadResult read_pbrt(const std::string& path, const ReadOptions& options = {});

// The same for text; names of files start at `folder`.
ReadResult read_pbrt_text(std::string_view text, const std::string& folder, const ReadOptions& options = {});

}  // namespace montelux
