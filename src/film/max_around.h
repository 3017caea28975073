// The largest value around each pixel.
#pragma once
#include "film/film_planes.h"

namespace montelux {

// The largest value of the (2 reach + 1) x (2 reach + 1) pixels around each pixel, of those that exist. `plane`: rows
// of `width` numbers.
Plane max_around(const Plane& plane, int width, int reach);

}  // namespace montelux
