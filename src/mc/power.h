// The power distribution (n + 1) x^n on [0, 1), n > -1.
#pragma once
#include "mc/density.h"
#include "mc/random.h"

namespace montelux {

template <class F>
MONTELUX_INLINE F sample_power(F n, F u) {
  return min(pow(u, F(1.0f) / (n + 1.0f)), F(one_minus_epsilon));
}
template <class F>
MONTELUX_INLINE Density<Length, F> power_density(F n, F x) {
  return {select((x >= F(0.0f)) & (x <= F(1.0f)), (n + 1.0f) * pow(x, n), F(0.0f))};
}
template <class F>
MONTELUX_INLINE F invert_power(F n, F x) {
  return min(pow(x, n + 1.0f), F(one_minus_epsilon));
}

// The same for whole n, as the largest of n + 1 uniform numbers, whose distribution function is x^(n + 1).
template <class F>
F sample_power_by_maximum(std::uint32_t n, RandomStream<F>& stream) {
  F x = 0.0f;
  for (std::uint32_t i = 0; i <= n; ++i) x = max(x, stream.next());
  return x;
}

}  // namespace montelux
