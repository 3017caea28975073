// The size of pixels on the surfaces that the camera sees.
#pragma once
#include "accel/accel.h"
#include "scene/scene.h"

namespace montelux {

// A radius of three pixels, where the middle one of some camera rays meets its first rough surface; at most a hundredth
// of the scene's diagonal.
float radius_by_footprint(const Scene& scene, const Accel& accel, int width, int height);

}  // namespace montelux
