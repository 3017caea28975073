// Settings of the path integrator.
#pragma once
#include <optional>

#include "parameter/choice.h"

namespace montelux {

// How many paths run side by side: `one` is the same loop over single floats, for tests and comparisons.
enum class Lanes { one, native };

struct PathSettings {
  // Scattering events at most; none: paths end by roulette alone, without bias.
  std::optional<int> max_depth;
  // Scattering events before roulette begins.
  int roulette_depth = 2;
  Lanes lanes = Lanes::native;
};

EntitySpec path_spec();
// All but max_depth, which a scene may state too.
PathSettings path_settings(const ParameterList& list);

}  // namespace montelux
