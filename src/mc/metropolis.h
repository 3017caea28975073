// The rule by which a Markov chain takes or leaves a move (Metropolis et al. 1953).
#pragma once
#include <algorithm>

namespace montelux {

// The probability with which a chain at a point of target `from` moves to one of target `to`, both not negative and not
// normalised, where the move is as probable as its reverse. A chain at a point of no target moves on.
inline double metropolis_acceptance(double from, double to) { return from > 0 ? std::min(1.0, to / from) : 1.0; }

}  // namespace montelux
