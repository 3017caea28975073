// Tables of eight words that stay in a register: a look-up costs no access to memory.
#pragma once
#include "math/lanes.h"

namespace montelux {

using SmallTable = std::array<std::uint32_t, 8>;

// table[i] in every lane; every i is below eight, in idle lanes too.
template <int N>
MONTELUX_INLINE Uints<N> look_up(const SmallTable& table, Uints<N> i) {
#if defined(__AVX2__)
  if constexpr (N >= 8) {
    __m256i words;
    std::memcpy(&words, table.data(), sizeof words);
#if defined(__AVX512F__)
    if constexpr (N == 16)
      return (typename Uints<N>::Vector)_mm512_maskz_permutexvar_epi32(0xffff, (__m512i)i.v,
                                                                       _mm512_maskz_broadcast_i64x4(0xff, words));
#endif
    if constexpr (N == 8) return (typename Uints<N>::Vector)_mm256_permutevar8x32_epi32(words, (__m256i)i.v);
  }
#endif
  return gather(table.data(), i);
}
MONTELUX_INLINE std::uint32_t look_up(const SmallTable& table, std::uint32_t i) { return table[i]; }

}  // namespace montelux
