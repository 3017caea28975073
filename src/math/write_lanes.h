// Some lanes of a pack as consecutive words.
#pragma once
#include "math/lanes.h"

namespace montelux {

// Writes the lanes that are on one after the other to `to`, which has room for all lanes.
template <int N, class Pack>
MONTELUX_INLINE void write_lanes(Bools<N> on, const Pack& a, void* to) {
  static_assert(sizeof(Pack) == 4 * N);
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  if constexpr (N == 16) {
    const __m512i packed = _mm512_maskz_compress_epi32(__mmask16(bits(on)), std::bit_cast<__m512i>(a));
    std::memcpy(to, &packed, sizeof packed);
    return;
  }
#endif
  auto* next = static_cast<char*>(to);
  for_each_lane(on, [&](int k) { std::memcpy(next, reinterpret_cast<const char*>(&a) + 4 * k, 4), next += 4; });
}

}  // namespace montelux
