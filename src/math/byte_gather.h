// Gathers of 32-bit words at byte offsets, aligned or not.
#pragma once
#include "math/lanes.h"

namespace montelux {

// The four bytes at base + i, lowest first, in every lane; i is below 2^31, and in range in idle lanes too.
template <int N>
MONTELUX_INLINE Uints<N> gather_bytes(const std::uint8_t* base, Uints<N> i) {
#if defined(__AVX512F__)
  if constexpr (N == 16)
    return (typename Uints<N>::Vector)_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), 0xffff, (__m512i)i.v, base,
                                                                  1);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8)
    return (typename Uints<N>::Vector)_mm256_i32gather_epi32(reinterpret_cast<const int*>(base), (__m256i)i.v, 1);
#endif
  Uints<N> r;
  for (int k = 0; k < N; ++k) {
    const std::uint8_t* b = base + i.v[k];
    r.v[k] = std::uint32_t(b[0]) | std::uint32_t(b[1]) << 8 | std::uint32_t(b[2]) << 16 | std::uint32_t(b[3]) << 24;
  }
  return r;
}

}  // namespace montelux
