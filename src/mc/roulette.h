// Russian roulette: a transform of a random variable that is often zero and preserves the expectation.
#pragma once
#include "mc/density.h"

namespace montelux {

// Roulette lets no path survive with certainty, or one between white walls would never end.
inline constexpr float max_survival = 0.97f;

template <class F>
struct Roulette {
  Mask<F> survives;
  F weight;  // 1 / q for the survivors, 0 for the others: its expectation is 1 for q > 0
};

// Survival with probability q, clamped to [0, 1], decided by u in [0, 1). q must not be 0 where the variable is not.
template <class F>
MONTELUX_INLINE Roulette<F> roulette(F q, F u) {
  Mask<F> survives = u < q;
  return {survives, select(survives, F(1.0f) / clamp(q, 1e-37f, 1.0f), F(0.0f))};
}

}  // namespace montelux
