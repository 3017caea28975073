// Moves of Markov chains, and the rule by which they are accepted (Metropolis et al. 1953).
#pragma once
#include <algorithm>
#include <cmath>

#include "math/functions.h"

namespace montelux {

// The probability that a chain at a point with target `from` moves to one with target `to`; both are non-negative and
// not normalised, and the proposal is symmetric. A chain at a point with target zero always moves.
inline double metropolis_acceptance(double from, double to) { return from > 0 ? std::min(1.0, to / from) : 1.0; }
// The same in lanes.
template <int N>
MONTELUX_INLINE Floats<N> metropolis_acceptance(Floats<N> from, std::type_identity_t<Floats<N>> to) {
  using F = Floats<N>;
  return select(from > F(0.0f), min(F(1.0f), to / max(from, F(1e-37f))), F(1.0f));
}

// A symmetric move of a number x in [0, 1), which wraps around: its size is between `smallest` and `largest`, with a
// density in inverse proportion to it (Kelemen et al. 2002, sec. 4), as u in [0, 1) decides.
template <class F>
MONTELUX_INLINE F moved(F x, F u, float smallest, float largest) {
  const Mask<F> forward = u < F(0.5f);
  const F v = select(forward, 2.0f * u, 2.0f * u - F(1.0f));
  const F size = largest * exp(F(std::log(smallest / largest)) * v);
  const F to = select(forward, x + size, x - size);
  const F wrapped = select(to >= F(1.0f), to - F(1.0f), select(to < F(0.0f), to + F(1.0f), to));
  return clamp(wrapped, 0.0f, 1.0f - 0x1p-24f);
}

}  // namespace montelux
