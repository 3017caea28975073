// The method `auto`: tries candidates on a small share of the samples and uses the most efficient.
#pragma once
#include "lab/integral/diagnosis.h"
#include "lab/integral/sampled.h"

namespace montelux::lab {

struct Choice {
  Method method;
  std::string why;                // what was measured
  std::uint64_t evaluations = 0;  // of the pilots, without the training
  // The estimates of the pilots with reliable error bars: the result is compared with them.
  std::vector<NamedEstimate> pilots{};
  TailProbe probe{};  // of the integrand; `evaluations` includes its evaluations
};

// By measured efficiency 1 / (variance x evaluations), extrapolated from the pilots' samples to `samples` at the
// observed rate. The pilots use less than a tenth of `samples`, and the choice is a pure function of its
// arguments.
// Adaptive methods are tried with the map after the first training steps, which are done here.
Choice choose_method(const Problem& problem, std::uint64_t seed, std::uint64_t samples, MapTraining& training);

}  // namespace montelux::lab
