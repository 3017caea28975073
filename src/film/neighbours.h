// What the neighbours of a pixel say of its expectation.
#pragma once
#include "film/film_planes.h"

namespace montelux {

// At every pixel the mean of the pixels around it, without itself, weighted by distance and by how alike albedo, normal
// and object are. As far as these are too few for their noise, that of a wider neighbourhood. Where there is no
// neighbour with a pass, the pixel's own mean.
ColorPlanes mean_of_neighbours(const FilmPlanes& planes);

}  // namespace montelux
