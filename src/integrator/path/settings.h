// Settings of the path integrator.
#pragma once
#include <optional>

namespace montelux {

// How many paths run side by side: `one` is the same loop over single floats, for tests and comparisons.
enum class Lanes { one, native };

struct PathSettings {
  // Scattering events at most; none: paths end by roulette alone, without bias.
  std::optional<int> max_depth;
  // Scattering events before roulette begins.
  int roulette_depth = 2;
  // Samples with a brighter component are scaled down to it: biased, and off unless asked for.
  std::optional<float> max_component;
  Lanes lanes = Lanes::native;
};

}  // namespace montelux
