// The shapes that a scene may state.
#pragma once
#include <span>

#include "parameter/spec.h"

namespace montelux {

// Every shape by name, with its parameters.
std::span<const EntitySpec> shape_table();

}  // namespace montelux
