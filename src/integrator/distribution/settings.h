// Settings of distribution ray tracing.
#pragma once
#include <optional>
#include <vector>

#include "parameter/choice.h"

namespace montelux {

struct DistributionSettings {
  // Secondary rays at the first, second, ... surface; the last holds for all that follow.
  std::vector<int> branching{8, 4, 1};
  // Shadow rays, likewise.
  std::vector<int> shadow_rays{4, 2, 1};
  // Scattering events at most; none: where one secondary ray is left, paths end by roulette, without bias.
  std::optional<int> max_depth;
};

EntitySpec distribution_spec();
// Fails where the rays would never end: more than one secondary ray at every depth, and no greatest depth.
Result<DistributionSettings> distribution_settings(const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
