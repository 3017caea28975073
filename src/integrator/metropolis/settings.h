// Settings of the metropolis integrator.
#pragma once
#include <optional>

#include "integrator/path/settings.h"
#include "parameter/choice.h"

namespace montelux {

struct MetropolisSettings {
  float large_step = 0.3f;         // probability of a step that draws all numbers again
  float largest_move = 1.0f / 64;  // of a number in a small step; the smallest is 1/16 of it
  int bootstrap = 1;             // independent paths for each pixel of a pass, which give the brightness and the seeds
  int roulette_depth = 2;        // scattering events before roulette
  std::optional<int> max_depth;  // of scattering events; none: roulette alone ends paths
};

EntitySpec metropolis_spec();
MetropolisSettings metropolis_settings(const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
