// The materials that a scene may state.
#pragma once
#include <span>

#include "parameter/spec.h"

namespace montelux {

// Every material by name, with its parameters.
std::span<const EntitySpec> material_table();

}  // namespace montelux
