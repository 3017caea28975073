// Packs of eight reals in double precision, for the few computations over rays that single precision cannot carry: a
// template over D, double or Doubles, states each of them once.
#pragma once
#include <limits>

#include "math/lanes.h"

namespace montelux {

inline constexpr int double_lanes = 8;

// Truth values; every lane is all ones (yes) or all zeros (no).
struct DoubleMask {
  typedef std::int64_t Vector __attribute__((vector_size(8 * double_lanes)));
  Vector v;
};

struct Doubles {
  typedef double Vector __attribute__((vector_size(8 * double_lanes)));
  Vector v;
  Doubles() = default;
  MONTELUX_INLINE Doubles(Vector a) : v(a) {}
  MONTELUX_INLINE Doubles(double a) : v(a - Vector{}) {}
};

template <class D>
struct DoubleTraits;
template <>
struct DoubleTraits<double> {
  using Mask = bool;
};
template <>
struct DoubleTraits<Doubles> {
  using Mask = DoubleMask;
};
template <class D>
using MaskOfDouble = typename DoubleTraits<D>::Mask;
// Lanes of D: 1 for double.
template <class D>
inline constexpr int lanes_of_double = sizeof(D) / sizeof(double);

// clang-format off
MONTELUX_INLINE Doubles operator+(Doubles a, Doubles b) { return a.v + b.v; }
MONTELUX_INLINE Doubles operator-(Doubles a, Doubles b) { return a.v - b.v; }
MONTELUX_INLINE Doubles operator*(Doubles a, Doubles b) { return a.v * b.v; }
MONTELUX_INLINE Doubles operator/(Doubles a, Doubles b) { return a.v / b.v; }
MONTELUX_INLINE Doubles operator-(Doubles a) { return -a.v; }
MONTELUX_INLINE DoubleMask operator<(Doubles a, Doubles b) { return {a.v < b.v}; }
MONTELUX_INLINE DoubleMask operator>(Doubles a, Doubles b) { return {a.v > b.v}; }
MONTELUX_INLINE DoubleMask operator<=(Doubles a, Doubles b) { return {a.v <= b.v}; }
MONTELUX_INLINE DoubleMask operator>=(Doubles a, Doubles b) { return {a.v >= b.v}; }
MONTELUX_INLINE DoubleMask operator!=(Doubles a, Doubles b) { return {a.v != b.v}; }
MONTELUX_INLINE DoubleMask operator&(DoubleMask a, DoubleMask b) { return {a.v & b.v}; }
MONTELUX_INLINE DoubleMask operator|(DoubleMask a, DoubleMask b) { return {a.v | b.v}; }
MONTELUX_INLINE DoubleMask operator!(DoubleMask a) { return {~a.v}; }
// clang-format on

MONTELUX_INLINE bool any(DoubleMask m) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return _mm512_movepi64_mask((__m512i)m.v) != 0;
#else
  std::int64_t all = 0;
  for (int k = 0; k < double_lanes; ++k) all |= m.v[k];
  return all != 0;
#endif
}

MONTELUX_INLINE Doubles select(DoubleMask m, Doubles a, Doubles b) { return m.v ? a.v : b.v; }
MONTELUX_INLINE double select(bool m, double a, double b) { return m ? a : b; }

MONTELUX_INLINE Doubles sqrt(Doubles a) {
#if defined(__AVX512F__)
  return (Doubles::Vector)_mm512_maskz_sqrt_pd(0xff, (__m512d)a.v);
#else
  Doubles r;
  for (int k = 0; k < double_lanes; ++k) r.v[k] = std::sqrt(a.v[k]);
  return r;
#endif
}
MONTELUX_INLINE double sqrt(double a) { return std::sqrt(a); }

// The magnitude of a with the sign of s.
MONTELUX_INLINE Doubles copysign(Doubles a, Doubles s) {
  const DoubleMask::Vector sign = DoubleMask::Vector{} + std::numeric_limits<std::int64_t>::min();
  return (Doubles::Vector)(((DoubleMask::Vector)a.v & ~sign) | ((DoubleMask::Vector)s.v & sign));
}
MONTELUX_INLINE double copysign(double a, double s) { return std::copysign(a, s); }

// min(a, b) is b where either is not a number.
MONTELUX_INLINE Doubles min(Doubles a, Doubles b) { return a.v < b.v ? a.v : b.v; }
MONTELUX_INLINE Doubles max(Doubles a, Doubles b) { return a.v > b.v ? a.v : b.v; }
MONTELUX_INLINE double min(double a, double b) { return a < b ? a : b; }
MONTELUX_INLINE double max(double a, double b) { return a > b ? a : b; }

// The nearest values of single precision, and back.
MONTELUX_INLINE Floats<double_lanes> to_single(Doubles a) {
  return __builtin_convertvector(a.v, Floats<double_lanes>::Vector);
}
MONTELUX_INLINE float to_single(double a) { return float(a); }
MONTELUX_INLINE Doubles to_double(Floats<double_lanes> a) { return __builtin_convertvector(a.v, Doubles::Vector); }
MONTELUX_INLINE double to_double(float a) { return a; }

// The nearest value of single precision, in double precision.
template <class D>
MONTELUX_INLINE D rounded_to_float(D a) {
  return to_double(to_single(a));
}

MONTELUX_INLINE double lane(const Doubles& a, int k) { return a.v[k]; }
MONTELUX_INLINE bool lane(const DoubleMask& a, int k) { return a.v[k] != 0; }
MONTELUX_INLINE void set_lane(Doubles& a, int k, double x) { a.v[k] = x; }
MONTELUX_INLINE double lane(double a, int) { return a; }
MONTELUX_INLINE void set_lane(double& a, int, double x) { a = x; }

}  // namespace montelux
