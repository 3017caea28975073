// The cameras that a scene may state.
#pragma once
#include <span>

#include "parameter/spec.h"

namespace montelux {

// Every camera by name, with its parameters.
std::span<const EntitySpec> camera_table();

}  // namespace montelux
