// Directions about an axis, peaked forward or backward: the distribution of Henyey and Greenstein.
#pragma once
#include "math/functions.h"
#include "math/vec.h"

namespace montelux {

// Henyey and Greenstein (1941), by the cosine between the direction of flight before and after; per steradian.
template <class F>
MONTELUX_INLINE F henyey_greenstein(F cosine, F g) {
  F d = max(F(1.0f) + g * g - 2.0f * g * cosine, F(1e-10f));
  return inv_four_pi * (F(1.0f) - g * g) / (d * sqrt(d));
}
// Samples a direction of flight after `forward` by henyey_greenstein().
template <class F>
MONTELUX_INLINE Vec3<F> sample_henyey_greenstein(Vec3<F> forward, F g, Vec2<F> u) {
  Mask<F> isotropic = abs(g) < F(1e-3f);
  F safe_g = select(isotropic, F(1.0f), g);
  F s = (F(1.0f) - g * g) / (F(1.0f) + g - 2.0f * g * u.y);
  F cosine = select(isotropic, F(1.0f) - 2.0f * u.y, (F(1.0f) + g * g - s * s) / (2.0f * safe_g));
  F c = clamp(cosine, F(-1.0f), F(1.0f));
  F sine = safe_sqrt(F(1.0f) - c * c);
  SinCos<F> phi = sin_cos_two_pi(u.x);
  return LocalFrame<F>::from_normal(forward).to_world({sine * phi.cos, sine * phi.sin, c});
}

}  // namespace montelux
