// Settings of the light integrator.
#pragma once
#include <optional>

#include "integrator/path/settings.h"
#include "parameter/choice.h"

namespace montelux {

struct LightTracingSettings {
  std::optional<int> max_depth;  // of scattering events; none: roulette alone ends paths, without bias
  int roulette_depth = 2;        // scattering events before roulette
  Lanes lanes = Lanes::native;
};

EntitySpec light_tracing_spec();
LightTracingSettings light_tracing_settings(const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
