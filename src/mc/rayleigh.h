// Directions about an axis by Rayleigh's law, the same forward and backward.
#pragma once
#include "math/functions.h"
#include "math/vec.h"

namespace montelux {

// 3 / (16 pi) (1 + cos^2), by the cosine between the direction of flight before and after; per steradian. Unpolarised
// light at particles much smaller than its wavelength.
template <class F>
MONTELUX_INLINE F rayleigh(F cosine) {
  return (0.75f * inv_four_pi) * (F(1.0f) + cosine * cosine);
}
// Samples a direction of flight after `forward` by rayleigh(): the cosine c solves c^3 + 3 c = 8 u - 4 (Cardano's
// formula; Frisvad 2011).
template <class F>
MONTELUX_INLINE Vec3<F> sample_rayleigh(Vec3<F> forward, Vec2<F> u) {
  const F q = F(4.0f) - 8.0f * u.y, half = 0.5f * abs(q);
  const F root = exp(log(half + sqrt(half * half + F(1.0f))) * F(1.0f / 3.0f));
  const F c = min(root - F(1.0f) / root, F(1.0f));
  const F cosine = select(q < F(0.0f), F(0.0f) - c, c);
  const F sine = safe_sqrt(F(1.0f) - cosine * cosine);
  const SinCos<F> phi = sin_cos_two_pi(u.x);
  return LocalFrame<F>::from_normal(forward).to_world({sine * phi.cos, sine * phi.sin, cosine});
}

}  // namespace montelux
