// What a scene may say about cameras.
#pragma once
#include <span>

#include "parameter/spec.h"

namespace montelux {

// Every camera by name, with its parameters.
std::span<const EntitySpec> camera_table();

}  // namespace montelux
