// The method `auto`: tries candidates on a small share of the samples and takes the most efficient.
#pragma once
#include "lab/integral/diagnosis.h"
#include "lab/integral/sampled.h"

namespace montelux::lab {

struct Choice {
  Method method;
  std::string why;                // what was measured
  std::uint64_t evaluations = 0;  // of the pilots, the training apart
  // What the pilots found, those aside whose error bars are not to be trusted: the result is held against them.
  std::vector<NamedEstimate> pilots{};
  TailProbe probe{};  // of the integrand; its evaluations are among those stated
};

// By measured efficiency 1 / (variance x evaluations), carried on from the pilots' samples to `samples` at the rate
// that is seen there. The pilots take less than a tenth of `samples`, and the choice is a pure function of its
// arguments.
// Methods that adapt are tried with the map of the training's first steps, which are taken here.
Choice choose_method(const Problem& problem, std::uint64_t seed, std::uint64_t samples, MapTraining& training);

}  // namespace montelux::lab
