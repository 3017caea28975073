// The lights that a scene may state.
#pragma once
#include <span>

#include "parameter/spec.h"

namespace montelux {

// Every light that is not an emitting shape, by name.
std::span<const EntitySpec> light_table();
// Every kind of emission that a shape may have.
std::span<const EntitySpec> area_light_table();

}  // namespace montelux
