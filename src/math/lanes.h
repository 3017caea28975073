// The lane layer: one name F for "a real number", either float or a pack of N floats, and the few operations that
// both share. Everything in the hot path is a template over F, written once.
//
//   F        float      Floats<N>     a real number in every lane
//   Uint<F>  uint32_t   Uints<N>      an index, a counter or bits in every lane
//   Mask<F>  bool       Bools<N>      a truth value in every lane
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "math/lane_types.h"
#include "math/mask_registers.h"

// The intrinsics below are used in their masked forms: g++ 12 warns of an uninitialised value inside the plain ones.

namespace montelux {

// ---- arithmetic -----------------------------------------------------------------------------------------------------

// clang-format off
template <int N> MONTELUX_INLINE Floats<N> operator+(Floats<N> a, Floats<N> b) { return a.v + b.v; }
template <int N> MONTELUX_INLINE Floats<N> operator-(Floats<N> a, Floats<N> b) { return a.v - b.v; }
template <int N> MONTELUX_INLINE Floats<N> operator*(Floats<N> a, Floats<N> b) { return a.v * b.v; }
template <int N> MONTELUX_INLINE Floats<N> operator/(Floats<N> a, Floats<N> b) { return a.v / b.v; }
template <int N> MONTELUX_INLINE Floats<N> operator+(Floats<N> a, float b) { return a.v + b; }
template <int N> MONTELUX_INLINE Floats<N> operator-(Floats<N> a, float b) { return a.v - b; }
template <int N> MONTELUX_INLINE Floats<N> operator*(Floats<N> a, float b) { return a.v * b; }
template <int N> MONTELUX_INLINE Floats<N> operator/(Floats<N> a, float b) { return a.v / b; }
template <int N> MONTELUX_INLINE Floats<N> operator+(float a, Floats<N> b) { return a + b.v; }
template <int N> MONTELUX_INLINE Floats<N> operator-(float a, Floats<N> b) { return a - b.v; }
template <int N> MONTELUX_INLINE Floats<N> operator*(float a, Floats<N> b) { return a * b.v; }
template <int N> MONTELUX_INLINE Floats<N> operator/(float a, Floats<N> b) { return a / b.v; }
template <int N> MONTELUX_INLINE Floats<N> operator-(Floats<N> a) { return -a.v; }
template <int N, class T> MONTELUX_INLINE Floats<N>& operator+=(Floats<N>& a, T b) { return a = a + b; }
template <int N, class T> MONTELUX_INLINE Floats<N>& operator-=(Floats<N>& a, T b) { return a = a - b; }
template <int N, class T> MONTELUX_INLINE Floats<N>& operator*=(Floats<N>& a, T b) { return a = a * b; }
template <int N, class T> MONTELUX_INLINE Floats<N>& operator/=(Floats<N>& a, T b) { return a = a / b; }

template <int N> MONTELUX_INLINE Bools<N> operator<(Floats<N> a, Floats<N> b) { return Bools<N>(a.v < b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator>(Floats<N> a, Floats<N> b) { return Bools<N>(a.v > b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator<=(Floats<N> a, Floats<N> b) { return Bools<N>(a.v <= b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator>=(Floats<N> a, Floats<N> b) { return Bools<N>(a.v >= b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator==(Floats<N> a, Floats<N> b) { return Bools<N>(a.v == b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator!=(Floats<N> a, Floats<N> b) { return Bools<N>(a.v != b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator<(Floats<N> a, float b) { return a < Floats<N>(b); }
template <int N> MONTELUX_INLINE Bools<N> operator>(Floats<N> a, float b) { return a > Floats<N>(b); }
template <int N> MONTELUX_INLINE Bools<N> operator<=(Floats<N> a, float b) { return a <= Floats<N>(b); }
template <int N> MONTELUX_INLINE Bools<N> operator>=(Floats<N> a, float b) { return a >= Floats<N>(b); }
template <int N> MONTELUX_INLINE Bools<N> operator==(Floats<N> a, float b) { return a == Floats<N>(b); }
template <int N> MONTELUX_INLINE Bools<N> operator!=(Floats<N> a, float b) { return a != Floats<N>(b); }

template <int N> MONTELUX_INLINE Uints<N> operator+(Uints<N> a, Uints<N> b) { return a.v + b.v; }
template <int N> MONTELUX_INLINE Uints<N> operator-(Uints<N> a, Uints<N> b) { return a.v - b.v; }
template <int N> MONTELUX_INLINE Uints<N> operator*(Uints<N> a, Uints<N> b) { return a.v * b.v; }
template <int N> MONTELUX_INLINE Uints<N> operator^(Uints<N> a, Uints<N> b) { return a.v ^ b.v; }
template <int N> MONTELUX_INLINE Uints<N> operator&(Uints<N> a, Uints<N> b) { return a.v & b.v; }
template <int N> MONTELUX_INLINE Uints<N> operator|(Uints<N> a, Uints<N> b) { return a.v | b.v; }
template <int N> MONTELUX_INLINE Uints<N> operator+(Uints<N> a, std::uint32_t b) { return a.v + b; }
template <int N> MONTELUX_INLINE Uints<N> operator-(Uints<N> a, std::uint32_t b) { return a.v - b; }
template <int N> MONTELUX_INLINE Uints<N> operator*(Uints<N> a, std::uint32_t b) { return a.v * b; }
template <int N> MONTELUX_INLINE Uints<N> operator^(Uints<N> a, std::uint32_t b) { return a.v ^ b; }
template <int N> MONTELUX_INLINE Uints<N> operator&(Uints<N> a, std::uint32_t b) { return a.v & b; }
template <int N> MONTELUX_INLINE Uints<N> operator|(Uints<N> a, std::uint32_t b) { return a.v | b; }
template <int N> MONTELUX_INLINE Uints<N> operator~(Uints<N> a) { return ~a.v; }
template <int N> MONTELUX_INLINE Uints<N> operator>>(Uints<N> a, int s) { return a.v >> s; }
template <int N> MONTELUX_INLINE Uints<N> operator<<(Uints<N> a, int s) { return a.v << s; }
template <int N> MONTELUX_INLINE Uints<N> operator>>(Uints<N> a, Uints<N> s) { return a.v >> s.v; }
template <int N> MONTELUX_INLINE Uints<N> operator<<(Uints<N> a, Uints<N> s) { return a.v << s.v; }
template <int N> MONTELUX_INLINE Bools<N> operator==(Uints<N> a, Uints<N> b) { return Bools<N>(a.v == b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator!=(Uints<N> a, Uints<N> b) { return Bools<N>(a.v != b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator<(Uints<N> a, Uints<N> b) { return Bools<N>(a.v < b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator>(Uints<N> a, Uints<N> b) { return Bools<N>(a.v > b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator<=(Uints<N> a, Uints<N> b) { return Bools<N>(a.v <= b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator>=(Uints<N> a, Uints<N> b) { return Bools<N>(a.v >= b.v); }

template <int N> MONTELUX_INLINE Bools<N> operator&(Bools<N> a, Bools<N> b) { return typename Bools<N>::Vector(a.v & b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator|(Bools<N> a, Bools<N> b) { return typename Bools<N>::Vector(a.v | b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator^(Bools<N> a, Bools<N> b) { return typename Bools<N>::Vector(a.v ^ b.v); }
template <int N> MONTELUX_INLINE Bools<N> operator!(Bools<N> a) { return typename Bools<N>::Vector(~a.v); }
// clang-format on

// ---- masks ----------------------------------------------------------------------------------------------------------

// Bit k of the result is lane k of the mask.
template <int N>
MONTELUX_INLINE std::uint32_t bits(Bools<N> m) {
#if defined(__AVX2__)
  if constexpr (N == 8) return std::uint32_t(_mm256_movemask_ps((__m256)m.v));
#endif
  std::uint32_t b = 0;
  for (int k = 0; k < N; ++k) b |= (std::uint32_t(m.v[k]) & 1u) << k;
  return b;
}
MONTELUX_INLINE std::uint32_t bits(bool m) { return m; }

// The mask whose lane k is bit k.
template <class F>
MONTELUX_INLINE Mask<F> mask_of_bits(std::uint32_t b) {
  if constexpr (lanes_of<F> == 1) {
    return (b & 1u) != 0;
  } else if constexpr (std::is_integral_v<typename Mask<F>::Vector>) {
    return typename Mask<F>::Vector(b);
  } else {
    Uint<F> lane;
    for (int k = 0; k < lanes_of<F>; ++k) lane.v[k] = 1u << k;
    return (Uint<F>(b) & lane) != Uint<F>(0u);
  }
}

template <int N>
MONTELUX_INLINE bool any(Bools<N> m) {
  return bits(m) != 0;
}
MONTELUX_INLINE bool any(bool m) { return m; }
template <int N>
MONTELUX_INLINE bool all(Bools<N> m) {
  return bits(m) == (N == 32 ? ~0u : (1u << N) - 1u);
}
MONTELUX_INLINE bool all(bool m) { return m; }
template <class M>
MONTELUX_INLINE int count(M m) {
  return std::popcount(bits(m));
}

// ---- choice ---------------------------------------------------------------------------------------------------------

template <int N>
MONTELUX_INLINE Floats<N> select(Bools<N> m, Floats<N> a, Floats<N> b) {
  return m.v ? a.v : b.v;
}
template <int N>
MONTELUX_INLINE Floats<N> select(Bools<N> m, Floats<N> a, float b) {
  return select(m, a, Floats<N>(b));
}
template <int N>
MONTELUX_INLINE Floats<N> select(Bools<N> m, float a, Floats<N> b) {
  return select(m, Floats<N>(a), b);
}
template <int N>
MONTELUX_INLINE Floats<N> select(Bools<N> m, float a, float b) {
  return select(m, Floats<N>(a), Floats<N>(b));
}
template <int N>
MONTELUX_INLINE Uints<N> select(Bools<N> m, Uints<N> a, Uints<N> b) {
  return m.v ? a.v : b.v;
}
template <int N>
MONTELUX_INLINE Bools<N> select(Bools<N> m, Bools<N> a, Bools<N> b) {
  return (m & a) | (!m & b);
}
MONTELUX_INLINE float select(bool m, float a, float b) { return m ? a : b; }
MONTELUX_INLINE std::uint32_t select(bool m, std::uint32_t a, std::uint32_t b) { return m ? a : b; }
MONTELUX_INLINE bool select(bool m, bool a, bool b) { return m ? a : b; }

// ---- elementary functions -------------------------------------------------------------------------------------------

template <int N, class Function>
MONTELUX_INLINE Floats<N> per_lane(Floats<N> a, Function f) {
  Floats<N> r;
  for (int k = 0; k < N; ++k) r.v[k] = f(a.v[k]);
  return r;
}

template <int N>
MONTELUX_INLINE Floats<N> sqrt(Floats<N> a) {
#if defined(__AVX512F__)
  if constexpr (N == 16) return (typename Floats<N>::Vector)_mm512_maskz_sqrt_ps(0xffff, (__m512)a.v);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8) return (typename Floats<N>::Vector)_mm256_sqrt_ps((__m256)a.v);
#endif
  return per_lane(a, [](float x) { return std::sqrt(x); });
}
MONTELUX_INLINE float sqrt(float a) { return std::sqrt(a); }

template <int N>
MONTELUX_INLINE Floats<N> floor(Floats<N> a) {
#if defined(__AVX512F__)
  if constexpr (N == 16)
    return (typename Floats<N>::Vector)_mm512_maskz_roundscale_ps(0xffff, (__m512)a.v, _MM_FROUND_TO_NEG_INF);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8) return (typename Floats<N>::Vector)_mm256_floor_ps((__m256)a.v);
#endif
  return per_lane(a, [](float x) { return std::floor(x); });
}
MONTELUX_INLINE float floor(float a) { return std::floor(a); }

// Nearest integer, ties to even.
template <int N>
MONTELUX_INLINE Floats<N> round(Floats<N> a) {
#if defined(__AVX512F__)
  if constexpr (N == 16)
    return (typename Floats<N>::Vector)_mm512_maskz_roundscale_ps(0xffff, (__m512)a.v, _MM_FROUND_TO_NEAREST_INT);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8)
    return (typename Floats<N>::Vector)_mm256_round_ps((__m256)a.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
#endif
  return per_lane(a, [](float x) { return std::nearbyint(x); });
}
MONTELUX_INLINE float round(float a) { return std::nearbyint(a); }

// min(a, b) is b where either is not a number, like the machine instruction; the same for one lane and for many.
template <int N>
MONTELUX_INLINE Floats<N> min(Floats<N> a, Floats<N> b) {
#if defined(__AVX512F__)
  if constexpr (N == 16) return (typename Floats<N>::Vector)_mm512_maskz_min_ps(0xffff, (__m512)a.v, (__m512)b.v);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8) return (typename Floats<N>::Vector)_mm256_min_ps((__m256)a.v, (__m256)b.v);
#endif
  return a.v < b.v ? a.v : b.v;
}
template <int N>
MONTELUX_INLINE Floats<N> max(Floats<N> a, Floats<N> b) {
#if defined(__AVX512F__)
  if constexpr (N == 16) return (typename Floats<N>::Vector)_mm512_maskz_max_ps(0xffff, (__m512)a.v, (__m512)b.v);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8) return (typename Floats<N>::Vector)_mm256_max_ps((__m256)a.v, (__m256)b.v);
#endif
  return a.v > b.v ? a.v : b.v;
}
template <int N>
MONTELUX_INLINE Floats<N> min(Floats<N> a, float b) {
  return min(a, Floats<N>(b));
}
template <int N>
MONTELUX_INLINE Floats<N> max(Floats<N> a, float b) {
  return max(a, Floats<N>(b));
}
MONTELUX_INLINE float min(float a, float b) { return a < b ? a : b; }
MONTELUX_INLINE float max(float a, float b) { return a > b ? a : b; }
template <int N>
MONTELUX_INLINE Uints<N> min(Uints<N> a, Uints<N> b) {
  return a.v < b.v ? a.v : b.v;
}
MONTELUX_INLINE std::uint32_t min(std::uint32_t a, std::uint32_t b) { return a < b ? a : b; }
template <class F>
MONTELUX_INLINE F clamp(F x, std::type_identity_t<F> low, std::type_identity_t<F> high) {
  return min(max(x, low), high);
}

// ---- conversion -----------------------------------------------------------------------------------------------------

template <int N>
MONTELUX_INLINE Uints<N> float_bits(Floats<N> a) {
  return (typename Uints<N>::Vector)a.v;
}
MONTELUX_INLINE std::uint32_t float_bits(float a) { return std::bit_cast<std::uint32_t>(a); }
template <int N>
MONTELUX_INLINE Floats<N> float_from_bits(Uints<N> a) {
  return (typename Floats<N>::Vector)a.v;
}
MONTELUX_INLINE float float_from_bits(std::uint32_t a) { return std::bit_cast<float>(a); }

// Valid for values below 2^31.
template <int N>
MONTELUX_INLINE Floats<N> to_float(Uints<N> a) {
  return __builtin_convertvector((typename Vectors<N>::Int)a.v, typename Floats<N>::Vector);
}
MONTELUX_INLINE float to_float(std::uint32_t a) { return float(std::int32_t(a)); }
// Toward zero; valid for values of magnitude below 2^31 (a negative value wraps as two's complement).
template <int N>
MONTELUX_INLINE Uints<N> to_uint(Floats<N> a) {
  return (typename Uints<N>::Vector) __builtin_convertvector(a.v, typename Vectors<N>::Int);
}
MONTELUX_INLINE std::uint32_t to_uint(float a) { return std::uint32_t(std::int32_t(a)); }

template <int N>
MONTELUX_INLINE Floats<N> abs(Floats<N> a) {
  return float_from_bits(float_bits(a) & 0x7fffffffu);
}
MONTELUX_INLINE float abs(float a) { return std::fabs(a); }
// The magnitude of a with the sign of s.
template <int N>
MONTELUX_INLINE Floats<N> copysign(Floats<N> a, Floats<N> s) {
  return float_from_bits((float_bits(a) & 0x7fffffffu) | (float_bits(s) & 0x80000000u));
}
template <int N>
MONTELUX_INLINE Floats<N> copysign(float a, Floats<N> s) {
  return copysign(Floats<N>(a), s);
}
MONTELUX_INLINE float copysign(float a, float s) { return std::copysign(a, s); }

template <int N>
MONTELUX_INLINE Bools<N> is_finite(Floats<N> a) {
  return Bools<N>((float_bits(a) & 0x7f800000u) != Uints<N>(0x7f800000u));
}
MONTELUX_INLINE bool is_finite(float a) { return (float_bits(a) & 0x7f800000u) != 0x7f800000u; }

// ---- lanes and memory -----------------------------------------------------------------------------------------------

template <int N>
MONTELUX_INLINE float lane(const Floats<N>& a, int k) {
  return a.v[k];
}
template <int N>
MONTELUX_INLINE std::uint32_t lane(const Uints<N>& a, int k) {
  return a.v[k];
}
template <int N>
MONTELUX_INLINE bool lane(const Bools<N>& a, int k) {
  return ((bits(a) >> k) & 1u) != 0;
}
MONTELUX_INLINE float lane(float a, int) { return a; }
MONTELUX_INLINE std::uint32_t lane(std::uint32_t a, int) { return a; }
MONTELUX_INLINE bool lane(bool a, int) { return a; }
template <int N>
MONTELUX_INLINE void set_lane(Floats<N>& a, int k, float x) {
  a.v[k] = x;
}
template <int N>
MONTELUX_INLINE void set_lane(Uints<N>& a, int k, std::uint32_t x) {
  a.v[k] = x;
}
MONTELUX_INLINE void set_lane(float& a, int, float x) { a = x; }
MONTELUX_INLINE void set_lane(std::uint32_t& a, int, std::uint32_t x) { a = x; }

// 0, 1, 2, ...
template <class F>
MONTELUX_INLINE Uint<F> lane_index() {
  if constexpr (lanes_of<F> == 1) {
    return 0u;
  } else {
    Uint<F> r;
    for (int k = 0; k < lanes_of<F>; ++k) r.v[k] = std::uint32_t(k);
    return r;
  }
}

// base[i] in every lane; every index must be in range, in idle lanes too. Indices below 2^31.
template <int N>
MONTELUX_INLINE Floats<N> gather(const float* base, Uints<N> i) {
#if defined(__AVX512F__)
  if constexpr (N == 16)
    return (typename Floats<N>::Vector)_mm512_mask_i32gather_ps(_mm512_setzero_ps(), 0xffff, (__m512i)i.v, base, 4);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8) return (typename Floats<N>::Vector)_mm256_i32gather_ps(base, (__m256i)i.v, 4);
#endif
  Floats<N> r;
  for (int k = 0; k < N; ++k) r.v[k] = base[i.v[k]];
  return r;
}
template <int N>
MONTELUX_INLINE Uints<N> gather(const std::uint32_t* base, Uints<N> i) {
#if defined(__AVX512F__)
  if constexpr (N == 16)
    return (typename Uints<N>::Vector)_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), 0xffff, (__m512i)i.v, base,
                                                                  4);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8)
    return (typename Uints<N>::Vector)_mm256_i32gather_epi32(reinterpret_cast<const int*>(base), (__m256i)i.v, 4);
#endif
  Uints<N> r;
  for (int k = 0; k < N; ++k) r.v[k] = base[i.v[k]];
  return r;
}
MONTELUX_INLINE float gather(const float* base, std::uint32_t i) { return base[i]; }
MONTELUX_INLINE std::uint32_t gather(const std::uint32_t* base, std::uint32_t i) { return base[i]; }

// Calls f(k) for each lane k that is on, in order.
template <class M, class Function>
MONTELUX_INLINE void for_each_lane(M on, Function f) {
  for (std::uint32_t b = bits(on); b != 0; b &= b - 1) f(std::countr_zero(b));
}

}  // namespace montelux
