// The paths of multiplexed Metropolis light transport.
#pragma once
#include <optional>

#include "integrator/bidirectional/settings.h"
#include "integrator/light_paths/light_media.h"
#include "integrator/metropolis/strategy_choice.h"
#include "mc/discrete.h"

namespace montelux {

// What the functions of all chains share.
struct StrategyPaths {
  BidirectionalPaths paths;
  const AliasTable* by_power = nullptr;     // null: there is no light
  const LightMedia* light_media = nullptr;  // null: the scene has no media, or no light
  const LightSet* compensated = nullptr;    // as BidirectionalFrame has it
  bool one_sided = false;                   // as BidirectionalFrame has it
  std::optional<StrategyChoice> choice{};   // none: of the pilot, which is given its strategies
};

}  // namespace montelux
