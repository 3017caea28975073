// Lanes of structs that are made of 32-bit words alone: one lane copied out of a pack and into it, or several.
#pragma once
#include <bit>
#include <cstring>
#include <span>

#include "math/row_gather.h"

namespace montelux {

// Copies one lane's worth of a struct that is made of 32-bit words alone into lane k, word by word.
template <template <class> class S, class F>
MONTELUX_INLINE void set_lane_words(S<F>& to_struct, int k, const S<float>& from_struct) {
  static_assert(sizeof(S<F>) == sizeof(S<float>) * lanes_of<F>);
  auto* to = reinterpret_cast<char*>(&to_struct) + 4 * std::size_t(k);
  const auto* from = reinterpret_cast<const char*>(&from_struct);
  for (std::size_t w = 0; w < sizeof(S<float>) / 4; ++w) std::memcpy(to + 4 * w * lanes_of<F>, from + 4 * w, 4);
}
template <template <class> class S, class F>
MONTELUX_INLINE void get_lane_words(const S<F>& from_struct, int k, S<float>& to_struct) {
  auto* to = reinterpret_cast<char*>(&to_struct);
  const auto* from = reinterpret_cast<const char*>(&from_struct) + 4 * std::size_t(k);
  for (std::size_t w = 0; w < sizeof(S<float>) / 4; ++w) std::memcpy(to + 4 * w, from + 4 * w * lanes_of<F>, 4);
}

// Copies structs into those lanes of a pack whose bits are set, as set_lane_words() does one: rows are transposed,
// which takes a fraction of the time. Every pointer must be valid, those of the other lanes, too.
template <class Pack, class One>
MONTELUX_INLINE void set_lanes_words(Pack& to_pack, [[maybe_unused]] std::uint32_t on,
                                     std::span<const One* const> from) {
  constexpr std::size_t words = sizeof(One) / 4, lanes = sizeof(Pack) / sizeof(One);
  static_assert(sizeof(Pack) == sizeof(One) * lanes);
  auto* to = reinterpret_cast<char*>(&to_pack);
#if defined(__AVX512F__)
  if constexpr (lanes == 16) {
    constexpr std::size_t width = std::min(words, std::size_t(words_of_row));
    const auto copy_words = [&](std::size_t first) {
      row_gather::Row rows[16]{};
      for (std::size_t k = 0; k < 16; ++k)
        std::memcpy(&rows[k], reinterpret_cast<const char*>(from[k]) + 4 * first, 4 * width);
      row_gather::transpose(rows);
      for (std::size_t w = 0; w < width; ++w)
        _mm512_mask_storeu_ps(to + 64 * (first + w), __mmask16(on), __m512(rows[w]));
    };
    for (std::size_t w = 0; w + width <= words; w += width) copy_words(w);
    if constexpr (words % width != 0) copy_words(words - width);  // overlaps the part before
    return;
  }
#endif
  for (std::size_t k = 0; k < lanes; ++k)
    if ((on >> k) & 1u)
      for (std::size_t w = 0; w < words; ++w)
        std::memcpy(to + 4 * (w * lanes + k), reinterpret_cast<const char*>(from[k]) + 4 * w, 4);
}
template <class Pack, class One>
MONTELUX_INLINE void set_all_lane_words(Pack& to_pack, std::span<const One* const> from) {
  set_lanes_words<Pack, One>(to_pack, ~0u, from);
}

// Copies the lanes whose bits are set into structs, one after the other.
template <class Pack, class One>
MONTELUX_INLINE void get_lanes_words(const Pack& from_pack, std::uint32_t on, One* to) {
  constexpr std::size_t words = sizeof(One) / 4, lanes = sizeof(Pack) / sizeof(One);
  static_assert(sizeof(Pack) == sizeof(One) * lanes);
  const auto* from = reinterpret_cast<const char*>(&from_pack);
  constexpr std::uint32_t all = std::uint32_t((std::uint64_t(1) << lanes) - 1);
#if defined(__AVX512F__)
  if constexpr (lanes == 16) {
    constexpr std::size_t width = std::min(words, std::size_t(words_of_row));
    const auto copy_words = [&](std::size_t first) {
      row_gather::Row rows[16]{};
      for (std::size_t w = 0; w < width; ++w) std::memcpy(&rows[w], from + 64 * (first + w), 64);
      row_gather::transpose(rows);
      One* next = to;
      for (std::uint32_t left = on & all; left != 0; left &= left - 1)
        std::memcpy(reinterpret_cast<char*>(next++) + 4 * first, &rows[std::countr_zero(left)], 4 * width);
    };
    for (std::size_t w = 0; w + width <= words; w += width) copy_words(w);
    if constexpr (words % width != 0) copy_words(words - width);
    return;
  }
#endif
  for (std::uint32_t left = on & all; left != 0; left &= left - 1, ++to)
    for (std::size_t w = 0; w < words; ++w)
      std::memcpy(reinterpret_cast<char*>(to) + 4 * w, from + 4 * (w * lanes + std::size_t(std::countr_zero(left))), 4);
}

// Lane by lane a or b, word by word, for such a struct in a pack.
template <template <class> class S, class F>
MONTELUX_INLINE S<F> select_words(Mask<F> m, const S<F>& a, const S<F>& b) {
  static_assert(sizeof(S<F>) == sizeof(S<float>) * lanes_of<F>);
  S<F> result = b;
  auto* to = reinterpret_cast<char*>(&result);
  const auto* from = reinterpret_cast<const char*>(&a);
  for (std::size_t at = 0; at < sizeof(S<F>); at += sizeof(F)) {
    Uint<F> x, y;
    std::memcpy(&x, from + at, sizeof(F)), std::memcpy(&y, to + at, sizeof(F));
    const Uint<F> chosen = select(m, x, y);
    std::memcpy(to + at, &chosen, sizeof(F));
  }
  return result;
}

}  // namespace montelux
