// Means over squares of pixels.
#pragma once
#include "film/film_planes.h"

namespace montelux {

// At each pixel the mean over the pixels of the image within `reach` in both directions.
Plane box_mean(const Plane& plane, int width, int height, int reach);

}  // namespace montelux
