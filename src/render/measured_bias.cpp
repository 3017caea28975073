#include "render/measured_bias.h"

#include "mc/moments.h"

namespace montelux {

std::optional<BiasEstimate> estimate_bias(const BiasOfPasses& passes) {
  if (passes.size() < 2) return std::nullopt;
  BiasEstimate estimate;
  estimate.passes = int(passes.size());
  for (std::size_t c = 0; c < estimate.mean.size(); ++c) {
    Moments differences;
    for (const auto& [pass, difference] : passes) differences.add(difference[c]);
    if (differences.non_finite > 0) return std::nullopt;
    estimate.mean[c] = differences.mean, estimate.standard_error[c] = differences.standard_error();
  }
  return estimate;
}

}  // namespace montelux
