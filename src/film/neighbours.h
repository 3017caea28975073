// Estimates the expectation of a pixel from its neighbours.
#pragma once
#include "film/film_planes.h"

namespace montelux {

// At every pixel the mean of the pixels around it, without itself, weighted by distance and by the similarity of
// albedo, normal and object. If these are too few for their noise, the mean shrinks toward that of a wider
// neighbourhood. If no neighbour has a pass, it is the pixel's own mean.
ColorPlanes mean_of_neighbours(const FilmPlanes& planes);

}  // namespace montelux
