// Settings of the look-development integrators: quick pictures of one property of the first surface.
#pragma once
#include "parameter/choice.h"

namespace montelux {

enum class Look { ambient_occlusion, normal, albedo, depth, irradiance };

struct LookSettings {
  Look look = Look::ambient_occlusion;
  int samples = 1;         // directions, or points of lights, of each camera ray
  float distance = 1e30f;  // ambient occlusion: what lies farther does not occlude
  bool by_cosine = true;   // ambient occlusion: how directions are drawn; the mean is the same
};

// ao, normal, albedo, depth, irradiance.
std::vector<EntitySpec> look_specs();
// `name` is that of one of the specs.
LookSettings look_settings(std::string_view name, const ParameterList& list);

}  // namespace montelux
