// The pixel filters that a scene may state.
#pragma once
#include <span>

#include "parameter/spec.h"

namespace montelux {

// Every pixel filter by name, with its parameters. Radii are in pixels.
std::span<const EntitySpec> filter_table();

}  // namespace montelux
