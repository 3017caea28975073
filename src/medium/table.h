// What a scene may say about participating media.
#pragma once
#include <span>

#include "parameter/spec.h"

namespace montelux {

std::span<const EntitySpec> medium_table();

}  // namespace montelux
