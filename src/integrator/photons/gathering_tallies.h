// Where the light of gathered photons comes from, by layers.
#pragma once
#include <array>
#include <optional>
#include <span>

#include "integrator/tally.h"

namespace montelux {

// The layers of a tile in a pass with layers: where the light of the paths comes from, and that of gather rays.
class GatheringTallies {
 public:
  // `layers`: null: there are none.
  GatheringTallies(const LayerPlan* layers, std::span<ExactRgb> sums) {
    if (layers) both_.emplace(std::array{LayerTally(*layers, 1, sums), LayerTally(*layers, 1, sums)});
  }
  std::array<LayerTally, 2>* get() { return both_ ? &*both_ : nullptr; }

 private:
  std::optional<std::array<LayerTally, 2>> both_;
};

}  // namespace montelux
