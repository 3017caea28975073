// Techniques whose terms are each a function of one point of the cube: f(x) / p(x) at the points of some point set.
#pragma once
#include "lab/integral/technique.h"

namespace montelux::lab {

std::unique_ptr<Technique> make_sampled(const Problem& problem, const Method& method);

}  // namespace montelux::lab
