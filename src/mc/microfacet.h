// The GGX (Trowbridge-Reitz) distribution of microscopic normals about +z, anisotropic, and its part that is visible
// from a direction. All formulas from Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based
// BRDFs"; sampling by Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps".
#pragma once
#include "mc/hemisphere.h"

namespace montelux {

// Widths along x and y; > 0.
template <class F>
struct Roughness {
  F x, y;
};

// Normals per steradian and unit area of the surface: the integral of D(m) cos(m) over the hemisphere is 1.
template <class F>
MONTELUX_INLINE F ggx_d(Vec3<F> m, Roughness<F> alpha) {
  F x = m.x / alpha.x, y = m.y / alpha.y;
  F k = x * x + y * y + m.z * m.z;
  return select(m.z > F(0.0f), inv_pi / (alpha.x * alpha.y * k * k), F(0.0f));
}

// Lambda of Smith's masking for the unit direction w; infinite at the horizon, where it is limited to a large number.
template <class F>
MONTELUX_INLINE F ggx_lambda(Vec3<F> w, Roughness<F> alpha) {
  F x = alpha.x * w.x, y = alpha.y * w.y;
  F a2 = (x * x + y * y) / max(w.z * w.z, F(1e-20f));
  // (sqrt(1 + a2) - 1) / 2 without cancellation for small a2.
  return 0.5f * a2 / (F(1.0f) + sqrt(F(1.0f) + a2));
}
// The fraction of the normals facing w that is visible from w.
template <class F>
MONTELUX_INLINE F ggx_g1(Vec3<F> w, Roughness<F> alpha) {
  return F(1.0f) / (F(1.0f) + ggx_lambda(w, alpha));
}
// The fraction visible from both wo and wi, with correlated heights (Heitz 2014, eq. 99); both above the surface.
template <class F>
MONTELUX_INLINE F ggx_g2(Vec3<F> wo, Vec3<F> wi, Roughness<F> alpha) {
  return F(1.0f) / (F(1.0f) + ggx_lambda(wo, alpha) + ggx_lambda(wi, alpha));
}

// A normal that is visible from wo (unit, wo.z > 0): in the space where the surface is a hemisphere, the reflection of
// wo is uniform on a spherical cap, and the normal lies halfway.
template <class F>
MONTELUX_INLINE Vec3<F> sample_visible_normal(Vec3<F> wo, Roughness<F> alpha, Vec2<F> u) {
  Vec3<F> v = normalize(Vec3<F>{alpha.x * wo.x, alpha.y * wo.y, wo.z});
  F z = (F(1.0f) - u.x) * (F(1.0f) + v.z) - v.z;
  Vec3<F> h = direction_at(clamp(z, -1.0f, 1.0f), u.y) + v;
  Vec3<F> m{alpha.x * h.x, alpha.y * h.y, max(h.z, F(1e-9f))};
  return normalize(m);
}
// G1(wo) |wo.m| D(m) / wo.z per steradian of the normal.
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> visible_normal_density(Vec3<F> wo, Vec3<F> m, Roughness<F> alpha) {
  F cos = max(dot(wo, m), F(0.0f));
  // G1 / wo.z = 2 / (wo.z + sqrt(wo.z^2 + ax^2 wo.x^2 + ay^2 wo.y^2)), finite at the horizon.
  F x = alpha.x * wo.x, y = alpha.y * wo.y;
  F g1_over_cos = F(2.0f) / (wo.z + sqrt(wo.z * wo.z + x * x + y * y));
  return {g1_over_cos * cos * ggx_d(m, alpha)};
}
template <class F>
MONTELUX_INLINE Vec2<F> invert_visible_normal(Vec3<F> wo, Vec3<F> m, Roughness<F> alpha) {
  Vec3<F> v = normalize(Vec3<F>{alpha.x * wo.x, alpha.y * wo.y, wo.z});
  Vec3<F> h = normalize(Vec3<F>{m.x / alpha.x, m.y / alpha.y, m.z});
  Vec3<F> cap = reflect(v, h);
  return {clamp(F(1.0f) - (cap.z + v.z) / (F(1.0f) + v.z), 0.0f, one_minus_epsilon), azimuth_fraction(cap)};
}

// A normal with density D(m) cos(m) per steradian, visible or not (Walter et al. 2007, eq. 35 and 36, stretched).
template <class F>
MONTELUX_INLINE Vec3<F> sample_ggx_normal(Roughness<F> alpha, Vec2<F> u) {
  SinCos<F> azimuth = sin_cos_two_pi(u.y);
  F slope = sqrt(u.x / (F(1.0f) - u.x));
  return normalize(Vec3<F>{alpha.x * slope * azimuth.cos, alpha.y * slope * azimuth.sin, F(1.0f)});
}
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> ggx_normal_density(Vec3<F> m, Roughness<F> alpha) {
  return {ggx_d(m, alpha) * max(m.z, F(0.0f))};
}
template <class F>
MONTELUX_INLINE Vec2<F> invert_ggx_normal(Vec3<F> m, Roughness<F> alpha) {
  Vec3<F> slope{m.x / alpha.x, m.y / alpha.y, F(0.0f)};
  F squared = dot(slope, slope);
  return {min(squared / (squared + m.z * m.z), F(one_minus_epsilon)), azimuth_fraction(slope)};
}

}  // namespace montelux
