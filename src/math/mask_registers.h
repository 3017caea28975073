// Comparison and choice of 16 lanes whose masks are in registers of their own. lanes.h states the same for any number
// of lanes, by vectors of truth values: a compiler that sees those alone (g++ 12 is one) moves every mask that it keeps
// to a vector and back.
#pragma once
#include "math/lane_types.h"

#if MONTELUX_MASK_REGISTERS
namespace montelux {

// clang-format off
MONTELUX_INLINE Bools<16> operator<(Floats<16> a, Floats<16> b) { return _mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, _CMP_LT_OQ); }
MONTELUX_INLINE Bools<16> operator>(Floats<16> a, Floats<16> b) { return _mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, _CMP_GT_OQ); }
MONTELUX_INLINE Bools<16> operator<=(Floats<16> a, Floats<16> b) { return _mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, _CMP_LE_OQ); }
MONTELUX_INLINE Bools<16> operator>=(Floats<16> a, Floats<16> b) { return _mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, _CMP_GE_OQ); }
MONTELUX_INLINE Bools<16> operator==(Floats<16> a, Floats<16> b) { return _mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, _CMP_EQ_OQ); }
MONTELUX_INLINE Bools<16> operator!=(Floats<16> a, Floats<16> b) { return _mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, _CMP_NEQ_UQ); }

MONTELUX_INLINE Bools<16> operator<(Uints<16> a, Uints<16> b) { return _mm512_cmp_epu32_mask((__m512i)a.v, (__m512i)b.v, _MM_CMPINT_LT); }
MONTELUX_INLINE Bools<16> operator>(Uints<16> a, Uints<16> b) { return _mm512_cmp_epu32_mask((__m512i)a.v, (__m512i)b.v, _MM_CMPINT_NLE); }
MONTELUX_INLINE Bools<16> operator<=(Uints<16> a, Uints<16> b) { return _mm512_cmp_epu32_mask((__m512i)a.v, (__m512i)b.v, _MM_CMPINT_LE); }
MONTELUX_INLINE Bools<16> operator>=(Uints<16> a, Uints<16> b) { return _mm512_cmp_epu32_mask((__m512i)a.v, (__m512i)b.v, _MM_CMPINT_NLT); }
MONTELUX_INLINE Bools<16> operator==(Uints<16> a, Uints<16> b) { return _mm512_cmp_epu32_mask((__m512i)a.v, (__m512i)b.v, _MM_CMPINT_EQ); }
MONTELUX_INLINE Bools<16> operator!=(Uints<16> a, Uints<16> b) { return _mm512_cmp_epu32_mask((__m512i)a.v, (__m512i)b.v, _MM_CMPINT_NE); }
// clang-format on

MONTELUX_INLINE std::uint32_t bits(Bools<16> m) { return m.v; }

MONTELUX_INLINE Floats<16> select(Bools<16> m, Floats<16> a, Floats<16> b) {
  return (Floats<16>::Vector)_mm512_mask_blend_ps(m.v, (__m512)b.v, (__m512)a.v);
}
MONTELUX_INLINE Uints<16> select(Bools<16> m, Uints<16> a, Uints<16> b) {
  return (Uints<16>::Vector)_mm512_mask_blend_epi32(m.v, (__m512i)b.v, (__m512i)a.v);
}

}  // namespace montelux
#endif
