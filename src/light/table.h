// The lights that a scene may state.
#pragma once
#include "light/description.h"
#include "parameter/models.h"

namespace montelux {

// Every light that is not an emitting shape, by name.
const Models<LightDesc>& light_models();
// Every kind of emission that a shape may have.
const Models<AreaLightDesc>& area_light_models();

}  // namespace montelux
