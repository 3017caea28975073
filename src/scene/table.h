// What a scene may state about the image and how to compute it.
#pragma once
#include <span>

#include "parameter/spec.h"

namespace montelux {

std::span<const EntitySpec> film_table();
// `instead` of a sampler is the name of the point set that replaces it.
std::span<const EntitySpec> sampler_table();
std::span<const EntitySpec> integrator_table();
// Accepted for compatibility with files that name one; the ray-tracing kernel builds its own.
std::span<const EntitySpec> accelerator_table();
// One entity, whose parameters are the options.
const EntitySpec& option_spec();

}  // namespace montelux
