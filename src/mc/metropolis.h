// The rule by which a Markov chain accepts or rejects a move (Metropolis et al. 1953).
#pragma once
#include <algorithm>

namespace montelux {

// The probability that a chain at a point with target `from` moves to one with target `to`; both are non-negative and
// not normalised, and the proposal is symmetric. A chain at a point with target zero always moves.
inline double metropolis_acceptance(double from, double to) { return from > 0 ? std::min(1.0, to / from) : 1.0; }

}  // namespace montelux
