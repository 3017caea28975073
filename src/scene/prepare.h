// From a scene as stated to a scene that can be rendered.
#pragma once
#include <optional>
#include <utility>

#include "scene/picture.h"
#include "scene/scene.h"

namespace montelux {

struct PrepareOptions {
  std::optional<std::pair<int, int>> resolution;  // overrides the film's
  ForEachNumber for_each{};                       // by which images are read; none: one after the other
};

struct PreparedScene {
  Scene scene;
  PictureSettings picture;
};

// Reads the images that the scene names. No value if there are new errors; all diagnostics are added to
// `diagnostics`.
std::optional<PreparedScene> prepare(const SceneDesc& desc, const PrepareOptions& options, Diagnostics& diagnostics);

}  // namespace montelux
