// Which materials may be perfect mirrors or smooth glass, whose light no sample of a lamp finds.
#pragma once
#include "scene/materials.h"

namespace montelux {

// Whether the material, or a part of a mixture, may reflect or refract as a perfect mirror or smooth glass somewhere:
// roughness that a texture states counts as smooth.
bool may_be_smooth(const MaterialSet& materials, std::size_t number);
// The same, with something rough beside or below it, as under a clear coat.
bool may_be_partly_smooth(const MaterialSet& materials, std::size_t number);

}  // namespace montelux
