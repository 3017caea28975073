// An environment map around a scene of any format.
#pragma once
#include <optional>
#include <string>

#include "parameter/diagnostic.h"
#include "scene/description.h"

namespace montelux {

// An image of all directions: twice as wide as high, longitude by latitude (equirectangular), or square and equal-area
// (Clarberg's octahedral map, as in pbrt). Column u of an equirectangular one shows the azimuth atan2(z, x) =
// 2 pi u, row v the angle acos(y) = pi v from the +y axis. A square one shows the same directions at the same angles
// from its own +z, which is +y of the world, and its own +x, which is that of the world.
struct Environment {
  std::string file;     // relative to the working directory
  double rotation = 0;  // degrees of rotation about +y, from +x towards +z
  double scale = 1;     // of its radiance
};

// Replaces the scene's own environments by this one. Reports a missing file.
void replace_environment(const Environment& environment, SceneDesc& scene, Diagnostics& diagnostics);

}  // namespace montelux
