// Settings of the choice between integrators.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/result.h"
#include "parameter/choice.h"

namespace montelux {

struct AutomaticSettings {
  std::vector<std::string> among{};  // candidates beside path, "restir-pt:rounds=2"; empty: automatic_candidates()
  float share = 0.04f;               // of the work, that pilots take
};

// Fewer lights with a place are not worth learning which of them are hidden, where there is no other light.
inline constexpr std::uint32_t several_lights = 3;

// An integrator that may be chosen.
struct AutomaticCandidate {
  std::string_view text;  // as for --integrator
  // The processor time of a ray over that of one by path, and about that of a sample. Measured by renders of 16 and 48
  // samples on veach-ajar, dining-room, living-room, coffee, many-lights-city, light-types and a Cornell box: 0.87 to
  // 1.19 and 2.8 to 12 for restir-pt, 0.73 to 1.4 and 1.4 to 3.7 for restir-di, 1.2 to 1.7 and 1.6 to 5.7 for bdpt; 1.0
  // and 1.0 for the roulette.
  double ray_cost, sample_cost;
  // Samples of path that take as long as making it: always; and more where the scene has a light at infinity that rays
  // meet, or several lights with a place, which it learns.
  double making, sky_making = 0, lights_making = 0;
};

// Those by default, and the costs of others by their name.
std::span<const AutomaticCandidate> automatic_candidates();
// The costs of an integrator that is not among them are taken as high.
AutomaticCandidate automatic_candidate(std::string_view text);

EntitySpec automatic_spec();
// Does not check whether the candidates are integrators.
Result<AutomaticSettings> automatic_settings(const ParameterList& list);

}  // namespace montelux
