// Settings of the metropolis integrator.
#pragma once
#include <optional>

#include "integrator/path/settings.h"
#include "parameter/choice.h"

namespace montelux {

// The paths on whose numbers the chains walk: those of the integrator of that name.
enum class MetropolisStrategies { path, bdpt };

struct MetropolisSettings {
  MetropolisStrategies strategies = MetropolisStrategies::path;
  float large_step = 0.3f;         // probability of a step that draws all numbers again
  float largest_move = 1.0f / 64;  // of a number in a small step; the smallest is 1/16 of it
  int bootstrap = 1;  // independent paths for each pixel of a pass, which give the brightness and the seeds
  // Scattering events before roulette. Pairs of subpaths have as many vertices as was chosen, so it ends few there.
  std::optional<int> roulette_depth;
  int depth_before_roulette() const {
    return roulette_depth.value_or(strategies == MetropolisStrategies::path ? 2 : 30);
  }
  std::optional<int> max_depth;  // of scattering events; none: roulette alone ends paths
  int width = 0, height = 0;     // of the picture, where strategies are tried before their use
};

EntitySpec metropolis_spec();
MetropolisSettings metropolis_settings(const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
