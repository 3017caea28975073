// Elementary functions for one lane or many: the same polynomial, hence the same bits, for every F.
// Each states its maximum error, which the unit tests check against the standard library in double precision.
#pragma once
#include <numbers>

#include "math/vec.h"

namespace montelux {

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float two_pi = 2.0f * pi;
inline constexpr float inv_pi = std::numbers::inv_pi_v<float>;
inline constexpr float inv_two_pi = 0.5f * inv_pi;
inline constexpr float inv_four_pi = 0.25f * inv_pi;
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;

template <class F>
MONTELUX_INLINE F square(F x) {
  return x * x;
}
// Zero for a negative argument.
template <class F>
MONTELUX_INLINE F safe_sqrt(F x) {
  return sqrt(max(x, F(0.0f)));
}
template <class F>
MONTELUX_INLINE F lerp(F t, F a, F b) {
  return (F(1.0f) - t) * a + t * b;
}

template <class F>
struct SinCos {
  F sin, cos;
};

// sin and cos of 2 pi u for u in [0, 1]: quarter turns and two short polynomials. Absolute error below 2e-7.
template <class F>
MONTELUX_INLINE SinCos<F> sin_cos_two_pi(F u) {
  F quarter = round(u * 4.0f);
  F x = (u - quarter * 0.25f) * two_pi;
  F x2 = x * x;
  F s = x * (F(1.0f) + x2 * (F(-1.6666654611e-1f) + x2 * (F(8.3321608736e-3f) + x2 * F(-1.9515295891e-4f))));
  F c = F(1.0f) + x2 * (F(-0.5f) + x2 * (F(4.166664568e-2f) + x2 * (F(-1.388731625e-3f) + x2 * F(2.443315711e-5f))));
  Uint<F> q = to_uint(quarter);
  Mask<F> odd = (q & Uint<F>(1u)) != Uint<F>(0u);
  F sine = select(odd, c, s), cosine = select(odd, s, c);
  Mask<F> flip_sin = (q & Uint<F>(2u)) != Uint<F>(0u);
  Mask<F> flip_cos = ((q + Uint<F>(1u)) & Uint<F>(2u)) != Uint<F>(0u);
  return {select(flip_sin, -sine, sine), select(flip_cos, -cosine, cosine)};
}

// sin and cos of an angle in radians, |x| up to about 1e3.
template <class F>
MONTELUX_INLINE SinCos<F> sin_cos(F x) {
  F turns = x * inv_two_pi;
  return sin_cos_two_pi(turns - floor(turns));
}

// Natural exponential, relative error below 2e-7; 0 below -87, the value at 88 above.
template <class F>
MONTELUX_INLINE F exp(F x) {
  F clamped = clamp(x, F(-87.0f), F(88.0f));
  F n = round(clamped * 1.44269504088896341f);
  F r = clamped - n * 0.693359375f - n * -2.12194440e-4f;
  F p = F(1.9875691500e-4f);
  p = p * r + F(1.3981999507e-3f);
  p = p * r + F(8.3334519073e-3f);
  p = p * r + F(4.1665795894e-2f);
  p = p * r + F(1.6666665459e-1f);
  p = p * r + F(5.0000001201e-1f);
  p = p * r * r + r + F(1.0f);
  F scale = float_from_bits(Uint<F>(to_uint(n) + Uint<F>(127u)) << 23);
  return select(x < F(-87.0f), F(0.0f), p * scale);
}

// Natural logarithm of a positive normal number, absolute error below 3e-7 (relative far from 1).
template <class F>
MONTELUX_INLINE F log(F x) {
  Uint<F> b = float_bits(max(x, F(1.17549435e-38f)));
  F e = to_float(Uint<F>((b >> 23) - Uint<F>(126u)));
  F m = float_from_bits((b & Uint<F>(0x007fffffu)) | Uint<F>(0x3f000000u));
  Mask<F> low = m < F(0.707106781186547524f);
  e = select(low, e - 1.0f, e);
  F r = select(low, m + m - 1.0f, m - 1.0f);
  F z = r * r;
  F p = F(7.0376836292e-2f);
  p = p * r - 1.1514610310e-1f;
  p = p * r + 1.1676998740e-1f;
  p = p * r - 1.2420140846e-1f;
  p = p * r + 1.4249322787e-1f;
  p = p * r - 1.6668057665e-1f;
  p = p * r + 2.0000714765e-1f;
  p = p * r - 2.4999993993e-1f;
  p = p * r + 3.3333331174e-1f;
  F y = r * z * p + e * -2.12194440e-4f - z * 0.5f;
  return r + y + e * 0.693359375f;
}

// x to the power y, for x >= 0; 0^0 is 1. Relative error grows with |y log x|, about 1e-7 times that.
template <class F>
MONTELUX_INLINE F pow(F x, F y) {
  F r = exp(y * log(x));
  return select(x <= F(0.0f), select(y == F(0.0f), F(1.0f), F(0.0f)), r);
}

// x to the power n for integers n from 0 to 2^20, by squaring; 0^0 is 1. Faster than pow() for n up to some hundreds.
template <class F>
MONTELUX_INLINE F whole_power(F x, F n) {
  F r = F(1.0f);
  n = min(n, F(0x1p20f));
  while (any(n >= F(1.0f))) {
    const F half = floor(n * 0.5f);
    r = select(n - half * 2.0f >= F(1.0f), r * x, r);
    x = x * x, n = half;
  }
  return r;
}

// Angle of the vector (x, y) in (-pi, pi], absolute error below 4e-7; 0 for the zero vector.
template <class F>
MONTELUX_INLINE F atan2(F y, F x) {
  F ax = abs(x), ay = abs(y);
  F big = max(ax, ay), small = min(ax, ay);
  F t = small / select(big == F(0.0f), F(1.0f), big);
  // Fold to |t| <= tan(pi/8).
  Mask<F> fold = t > F(0.41421356237f);
  F v = select(fold, (t - 1.0f) / (t + 1.0f), t);
  F z = v * v;
  F p = F(8.05374449538e-2f);
  p = p * z - 1.38776856032e-1f;
  p = p * z + 1.99777106478e-1f;
  p = p * z - 3.33329491539e-1f;
  F a = p * z * v + v + select(fold, F(0.25f * pi), F(0.0f));
  a = select(ay > ax, 0.5f * pi - a, a);
  a = select(x < F(0.0f), pi - a, a);
  return copysign(a, y);
}

// Arc cosine and sine of x clamped to [-1, 1], absolute error below 5e-7.
template <class F>
MONTELUX_INLINE F acos(F x) {
  F c = clamp(x, F(-1.0f), F(1.0f));
  return atan2(safe_sqrt((F(1.0f) - c) * (F(1.0f) + c)), c);
}
template <class F>
MONTELUX_INLINE F asin(F x) {
  F s = clamp(x, F(-1.0f), F(1.0f));
  return atan2(s, safe_sqrt((F(1.0f) - s) * (F(1.0f) + s)));
}

// The angle between two unit vectors, accurate when they are nearly parallel or opposite (Kahan).
template <class F>
MONTELUX_INLINE F angle_between(Vec3<F> a, Vec3<F> b) {
  return 2.0f * atan2(length(a - b), length(a + b));
}

}  // namespace montelux
