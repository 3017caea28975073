// A panorama around a scene, whatever its format.
#pragma once
#include <optional>
#include <string>

#include "parameter/diagnostic.h"
#include "scene/description.h"

namespace montelux {

// An image of all directions: twice as wide as high, longitude by latitude (equirectangular), or square, of equal areas
// (Clarberg's octahedral map, as pbrt has it). Column u of an equirectangular one shows the azimuth atan2(z, x) =
// 2 pi u, row v the angle acos(y) = pi v from the +y axis. A square one shows the same directions at the same angles
// from its own +z, which is +y of the world, and its +x, which stays.
struct Environment {
  std::string file;     // relative to the working directory
  double rotation = 0;  // degrees by which it is turned about +y, from +x toward +z
  double scale = 1;     // of its radiance
};

// The environment takes the place of the scene's own ones. Reports a file that is not there.
void replace_environment(const Environment& environment, SceneDesc& scene, Diagnostics& diagnostics);

}  // namespace montelux
