// Scene descriptions as text.
#pragma once
#include <string>

#include "math/result.h"
#include "scene/description.h"

namespace montelux {

// The scene in the text format of pbrt-v4; reading it from the folder of the scene gives the same description, except
// that materials without a name get one, and that motion through more than two transforms is reduced to the first and
// the last. The rgb values of one entity must share a colour space.
std::string write_pbrt(const SceneDesc& scene);

// The same into a file, which should be in the scene's folder: the paths in it are relative to that.
Status write_pbrt_file(const SceneDesc& scene, const std::string& path);

}  // namespace montelux
