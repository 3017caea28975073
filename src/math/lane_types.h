// The types of lanes.h.
#pragma once
#include <cstdint>
#if defined(__AVX2__)
#include <immintrin.h>
#endif

// Whether the machine has registers for the masks of 16 floats and of 8 doubles, with bit k for lane k.
#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define MONTELUX_MASK_REGISTERS 1
#else
#define MONTELUX_MASK_REGISTERS 0
#endif

#define MONTELUX_INLINE inline __attribute__((always_inline))

namespace montelux {

// The widest pack that fits a register of this machine.
#if MONTELUX_MASK_REGISTERS
inline constexpr int native_lanes = 16;
#elif defined(__AVX2__)
inline constexpr int native_lanes = 8;
#else
inline constexpr int native_lanes = 4;
#endif

// The compiler's vector types, by number of lanes.
template <int N>
struct Vectors;
template <>
struct Vectors<4> {
  typedef float Float __attribute__((vector_size(16)));
  typedef std::int32_t Int __attribute__((vector_size(16)));
  typedef std::uint32_t Uint __attribute__((vector_size(16)));
};
template <>
struct Vectors<8> {
  typedef float Float __attribute__((vector_size(32)));
  typedef std::int32_t Int __attribute__((vector_size(32)));
  typedef std::uint32_t Uint __attribute__((vector_size(32)));
};
template <>
struct Vectors<16> {
  typedef float Float __attribute__((vector_size(64)));
  typedef std::int32_t Int __attribute__((vector_size(64)));
  typedef std::uint32_t Uint __attribute__((vector_size(64)));
};

// N truth values; every lane is all ones (yes) or all zeros (no).
template <int N>
struct Bools {
  using Vector = typename Vectors<N>::Int;
  Vector v;
  Bools() = default;
  MONTELUX_INLINE Bools(Vector a) : v(a) {}
  MONTELUX_INLINE Bools(bool b) : v(Vector{} - std::int32_t(b)) {}
};
#if MONTELUX_MASK_REGISTERS
template <>
struct Bools<16> {
  using Vector = __mmask16;
  Vector v;
  Bools() = default;
  MONTELUX_INLINE Bools(Vector a) : v(a) {}
  MONTELUX_INLINE Bools(bool b) : v(b ? 0xffff : 0) {}
};
#endif

template <int N>
struct Floats;

// N unsigned 32-bit integers, wrapping.
template <int N>
struct Uints {
  using Vector = typename Vectors<N>::Uint;
  Vector v;
  Uints() = default;
  MONTELUX_INLINE Uints(Vector a) : v(a) {}
  MONTELUX_INLINE Uints(std::uint32_t a) : v(Vector{} + a) {}
};

// N single-precision reals.
template <int N>
struct Floats {
  using Vector = typename Vectors<N>::Float;
  Vector v;
  Floats() = default;
  MONTELUX_INLINE Floats(Vector a) : v(a) {}
  MONTELUX_INLINE Floats(float a) : v(a - Vector{}) {}
};

using NativeFloats = Floats<native_lanes>;

template <class F>
struct LaneTraits;
template <>
struct LaneTraits<float> {
  static constexpr int lanes = 1;
  using Uint = std::uint32_t;
  using Mask = bool;
};
template <int N>
struct LaneTraits<Floats<N>> {
  static constexpr int lanes = N;
  using Uint = Uints<N>;
  using Mask = Bools<N>;
};
template <class F>
inline constexpr int lanes_of = LaneTraits<F>::lanes;
template <class F>
using Uint = typename LaneTraits<F>::Uint;
template <class F>
using Mask = typename LaneTraits<F>::Mask;

}  // namespace montelux
