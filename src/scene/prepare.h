// From a scene as stated to a scene that can be rendered.
#pragma once
#include <optional>
#include <utility>

#include "scene/picture.h"
#include "scene/scene.h"

namespace montelux {

struct PrepareOptions {
  std::optional<std::pair<int, int>> resolution;  // instead of the film's
};

struct PreparedScene {
  Scene scene;
  PictureSettings picture;
};

// Reads the images that the scene names. No value where anything is wrong that was not wrong before; all of it is in
// `diagnostics`.
std::optional<PreparedScene> prepare(const SceneDesc& desc, const PrepareOptions& options, Diagnostics& diagnostics);

}  // namespace montelux
