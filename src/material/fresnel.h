// Reflection and refraction at a plane interface.
#pragma once
#include "color/spectrum.h"

namespace montelux {

// Fraction of unpolarised light that an interface of two dielectrics reflects (Fresnel 1823). `eta` is the index below
// the surface over that above; cos_i, of the incident direction to the normal, is negative below. 1 at total internal
// reflection.
template <class F>
MONTELUX_INLINE F fresnel_dielectric(F cos_i, F eta) {
  F c = clamp(abs(cos_i), F(0.0f), F(1.0f));
  F relative = select(cos_i < F(0.0f), F(1.0f) / eta, eta);
  F sin2_t = (F(1.0f) - c * c) / (relative * relative);
  F cos_t = safe_sqrt(F(1.0f) - sin2_t);
  F parallel = (relative * c - cos_t) / (relative * c + cos_t);
  F perpendicular = (c - relative * cos_t) / (c + relative * cos_t);
  F reflected = 0.5f * (parallel * parallel + perpendicular * perpendicular);
  return select(sin2_t >= F(1.0f), F(1.0f), reflected);
}

// The same for a conductor of relative index eta + i k, cos_i >= 0 (Born and Wolf 1999, sec. 14.2, in real arithmetic).
template <class F>
MONTELUX_INLINE F fresnel_conductor(F cos_i, F eta, F k) {
  F c = clamp(cos_i, F(0.0f), F(1.0f));
  F c2 = c * c, s2 = F(1.0f) - c2;
  F eta2 = eta * eta, k2 = k * k;
  F t0 = eta2 - k2 - s2;
  F a2_plus_b2 = sqrt(t0 * t0 + 4.0f * eta2 * k2);
  F a = safe_sqrt(0.5f * (a2_plus_b2 + t0));
  F t1 = a2_plus_b2 + c2, t2 = 2.0f * c * a;
  F perpendicular = (t1 - t2) / max(t1 + t2, F(1e-30f));
  F t3 = c2 * a2_plus_b2 + s2 * s2, t4 = t2 * s2;
  F parallel = perpendicular * (t3 - t4) / max(t3 + t4, F(1e-30f));
  return 0.5f * (perpendicular + parallel);
}
template <class F>
MONTELUX_INLINE Spectrum<F> fresnel_conductor(F cos_i, const Spectrum<F>& eta, const Spectrum<F>& k) {
  return per_component([cos_i](F n, F x) { return fresnel_conductor(cos_i, n, x); }, eta, k);
}

// The direction, unit and away from the surface, into which w (on either side of n) refracts (Snell).
template <class F>
struct Refraction {
  Vec3<F> wt;
  F relative_eta;  // index on the side of wt over that on the side of w
  Mask<F> valid;   // no: total internal reflection; wt is then meaningless
};
template <class F>
MONTELUX_INLINE Refraction<F> refract(Vec3<F> w, Vec3<F> n, F eta) {
  F c = dot(n, w);
  F sign = copysign(F(1.0f), c);
  F relative = select(c < F(0.0f), F(1.0f) / eta, eta);
  F cos_i = abs(c);
  F sin2_t = max(F(1.0f) - cos_i * cos_i, F(0.0f)) / (relative * relative);
  F cos_t = safe_sqrt(F(1.0f) - sin2_t);
  return {n * (sign * (cos_i / relative - cos_t)) - w * (F(1.0f) / relative), relative, sin2_t < F(1.0f)};
}

}  // namespace montelux
