// Settings of the bidirectional integrators.
#pragma once
#include <optional>

#include "integrator/path/settings.h"
#include "parameter/choice.h"

namespace montelux {

// How the strategies share the light that several of them find.
enum class BidirectionalMis { balance, power };

// Both subpaths.
struct BidirectionalPaths {
  std::optional<int> max_depth;  // of scattering events between the light and the camera
  int roulette_depth = 2;        // scattering events of a subpath before roulette
  BidirectionalMis mis = BidirectionalMis::power;
  bool connect = true;  // vertices with each other, with lights and with the lens; else they are merged alone
  Lanes lanes = Lanes::native;
};

EntitySpec bdpt_spec();
BidirectionalPaths bdpt_settings(const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
