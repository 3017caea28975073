// Settings of the recursive path tracer of the lecture notes.
#pragma once
#include <optional>

#include "parameter/choice.h"

namespace montelux {

struct TracePathSettings {
  // Probability of taking the emitted light where a surface both shines and scatters.
  float p_emit = 0.9f;
  // Scattering events before roulette begins.
  int roulette_depth = 1;
  // Scattering events at most; none: the recursion ends by roulette alone, without bias.
  std::optional<int> max_depth;
};

EntitySpec tracepath_spec();
// All but max_depth, which a scene may state too.
TracePathSettings tracepath_settings(const ParameterList& list);

}  // namespace montelux
