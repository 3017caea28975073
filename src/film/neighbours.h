// What the neighbours of a pixel say of its expectation.
#pragma once
#include "film/film_planes.h"

namespace montelux {

// At every pixel the mean of the pixels around it, without itself, weighted by distance and by how alike albedo, normal
// and object are. Where there is no neighbour with a pass, the pixel's own mean.
ColorPlanes mean_of_neighbours(const FilmPlanes& planes);

}  // namespace montelux
