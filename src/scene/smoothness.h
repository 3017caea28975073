// Which materials may be perfect mirrors or smooth glass, through which light sampling finds no light.
#pragma once
#include "scene/materials.h"

namespace montelux {

// Whether the material, or a part of a mixture, may reflect or refract like a perfect mirror or smooth glass somewhere:
// textured roughness counts as smooth.
bool may_be_smooth(const MaterialSet& materials, std::size_t number);
// The same, combined with something rough, as under a clear coat.
bool may_be_partly_smooth(const MaterialSet& materials, std::size_t number);
// Whether it may be smooth, and then has the events of specular_lobe() and the normals of the geometry: light that it
// reflects or refracts has the differentials of NormalGradient.
bool is_plain_specular(const MaterialSet& materials, std::size_t number);
// Whether it is rough everywhere, with facets that have the events of specular_lobe(), with the normals of the geometry
// and one roughness, `max_roughness` at most, in all places and directions.
bool is_plain_rough(const MaterialSet& materials, std::size_t number, float max_roughness);

}  // namespace montelux
