// Packs of eight reals in double precision, for the few computations over rays that single precision cannot carry: a
// template over D, double or Doubles, states each of them once.
#pragma once
#include <limits>

#include "math/lanes.h"

namespace montelux {

inline constexpr int double_lanes = 8;

struct Doubles {
  typedef double Vector __attribute__((vector_size(8 * double_lanes)));
  typedef std::int64_t Bits __attribute__((vector_size(8 * double_lanes)));
  Vector v;
  Doubles() = default;
  MONTELUX_INLINE Doubles(Vector a) : v(a) {}
  MONTELUX_INLINE Doubles(double a) : v(a - Vector{}) {}
};

// Truth values, as those of Bools.
struct DoubleMask {
#if MONTELUX_MASK_REGISTERS
  using Vector = __mmask8;
#else
  using Vector = Doubles::Bits;
#endif
  Vector v;
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
#if MONTELUX_MASK_REGISTERS
MONTELUX_INLINE DoubleMask operator<(Doubles a, Doubles b) { return {_mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_LT_OQ)}; }
MONTELUX_INLINE DoubleMask operator>(Doubles a, Doubles b) { return {_mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_GT_OQ)}; }
MONTELUX_INLINE DoubleMask operator<=(Doubles a, Doubles b) { return {_mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_LE_OQ)}; }
MONTELUX_INLINE DoubleMask operator>=(Doubles a, Doubles b) { return {_mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_GE_OQ)}; }
MONTELUX_INLINE DoubleMask operator!=(Doubles a, Doubles b) { return {_mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_NEQ_UQ)}; }
#else
MONTELUX_INLINE DoubleMask operator<(Doubles a, Doubles b) { return {a.v < b.v}; }
MONTELUX_INLINE DoubleMask operator>(Doubles a, Doubles b) { return {a.v > b.v}; }
MONTELUX_INLINE DoubleMask operator<=(Doubles a, Doubles b) { return {a.v <= b.v}; }
MONTELUX_INLINE DoubleMask operator>=(Doubles a, Doubles b) { return {a.v >= b.v}; }
MONTELUX_INLINE DoubleMask operator!=(Doubles a, Doubles b) { return {a.v != b.v}; }
#endif
MONTELUX_INLINE DoubleMask operator&(DoubleMask a, DoubleMask b) { return {DoubleMask::Vector(a.v & b.v)}; }
MONTELUX_INLINE DoubleMask operator|(DoubleMask a, DoubleMask b) { return {DoubleMask::Vector(a.v | b.v)}; }
MONTELUX_INLINE DoubleMask operator!(DoubleMask a) { return {DoubleMask::Vector(~a.v)}; }
// clang-format on

#if MONTELUX_MASK_REGISTERS
MONTELUX_INLINE bool lane(DoubleMask a, int k) { return ((a.v >> k) & 1) != 0; }
MONTELUX_INLINE void set_lane(DoubleMask& a, int k, bool yes) {
  a.v = DoubleMask::Vector((a.v & ~(1 << k)) | (int(yes) << k));
}
MONTELUX_INLINE bool any(DoubleMask m) { return m.v != 0; }
MONTELUX_INLINE Doubles select(DoubleMask m, Doubles a, Doubles b) {
  return (Doubles::Vector)_mm512_mask_blend_pd(m.v, (__m512d)b.v, (__m512d)a.v);
}
#else
MONTELUX_INLINE bool lane(DoubleMask a, int k) { return a.v[k] != 0; }
MONTELUX_INLINE void set_lane(DoubleMask& a, int k, bool yes) { a.v[k] = yes ? -1 : 0; }
MONTELUX_INLINE bool any(DoubleMask m) {
  std::int64_t all = 0;
  for (int k = 0; k < double_lanes; ++k) all |= m.v[k];
  return all != 0;
}
MONTELUX_INLINE Doubles select(DoubleMask m, Doubles a, Doubles b) { return m.v ? a.v : b.v; }
#endif
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
  const Doubles::Bits sign = Doubles::Bits{} + std::numeric_limits<std::int64_t>::min();
  return (Doubles::Vector)(((Doubles::Bits)a.v & ~sign) | ((Doubles::Bits)s.v & sign));
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
MONTELUX_INLINE void set_lane(Doubles& a, int k, double x) { a.v[k] = x; }
MONTELUX_INLINE double lane(double a, int) { return a; }
MONTELUX_INLINE void set_lane(double& a, int, double x) { a = x; }

}  // namespace montelux
