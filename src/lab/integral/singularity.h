// Whether an integrand grows without bound, and how heavy the tail of its values at uniform points is.
#pragma once
#include "lab/integral/integrand.h"
#include "lab/integral/state.h"

namespace montelux::lab {

// Uniform points give the tail of the values. If it is heavy, a search finds the largest values in boxes that
// shrink around the best point so far, and measures there how the integrand f grows with the distance h: f ~
// h^-exponent. A bounded peak, however narrow (down to 1e-6 of the domain's width), has the exponent 0. Uses at most
// `budget` evaluations; nothing if they are too few for the dimension.
TailProbe probe_tail(const Integrand& integrand, std::uint64_t seed, std::uint64_t budget);

}  // namespace montelux::lab
