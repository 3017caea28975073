// The bias of a picture, by passes that compared some of their samples with unbiased ones.
#pragma once
#include <map>
#include <optional>

#include "integrator/integrator.h"

namespace montelux {

// By the number of the pass. A pass that compared nothing is not there.
using BiasOfPasses = std::map<int, MeanDifference>;

// Of the mean of the whole picture, by colour.
struct BiasEstimate {
  MeanDifference mean{}, standard_error{};
  int passes = 0;
};
// Passes are independent, so their spread is the error whatever the correlation within each; none below two passes.
std::optional<BiasEstimate> estimate_bias(const BiasOfPasses& passes);

}  // namespace montelux
