#include "render/measured_bias.h"

#include <cmath>

namespace montelux {

std::optional<BiasEstimate> estimate_bias(const BiasOfPasses& passes) {
  if (passes.size() < 2) return std::nullopt;
  const auto n = double(passes.size());
  BiasEstimate estimate;
  estimate.passes = int(passes.size());
  for (std::size_t c = 0; c < estimate.mean.size(); ++c) {
    double sum = 0, squares = 0;
    for (const auto& [pass, difference] : passes) sum += difference[c];
    const double mean = sum / n;
    for (const auto& [pass, difference] : passes) squares += (difference[c] - mean) * (difference[c] - mean);
    estimate.mean[c] = mean, estimate.standard_error[c] = std::sqrt(squares / (n - 1) / n);
  }
  return estimate;
}

}  // namespace montelux
