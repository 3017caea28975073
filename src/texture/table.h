// The textures that a scene may state.
#pragma once
#include "parameter/models.h"
#include "texture/description.h"

namespace montelux {

// Every texture by name, with its parameters. A parameter that takes numbers and spectra takes the kind of the texture
// that has it: numbers in a texture of numbers, spectra in a texture of spectra.
const Models<TextureDesc>& texture_models();

}  // namespace montelux
