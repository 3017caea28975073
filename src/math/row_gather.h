// Records of sixteen or eight words, one in every lane: whole rows are loaded and transposed, which takes a fraction of
// the time of as many gathers.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>

#include "math/lanes.h"
#include "math/prefetch.h"

namespace montelux {

inline constexpr int words_of_row = 16, words_of_short_row = 8;

#if defined(__AVX512F__)
namespace row_gather {

using Row = Vectors<16>::Float;

// clang-format off
MONTELUX_INLINE Row low_words(Row a, Row b) { return __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29); }
MONTELUX_INLINE Row high_words(Row a, Row b) { return __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31); }
MONTELUX_INLINE Row low_pairs(Row a, Row b) { return __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29); }
MONTELUX_INLINE Row high_pairs(Row a, Row b) { return __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31); }
MONTELUX_INLINE Row even_fours(Row a, Row b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27); }
MONTELUX_INLINE Row odd_fours(Row a, Row b) { return __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31); }
// clang-format on

// Transposes the squares of 4 x 4 words: word w of square q of row 4 j + k becomes word k of square q of row 4 j + w.
template <int n>
MONTELUX_INLINE void transpose_squares(const Row (&r)[n], Row (&u)[n]) {
  Row t[n];
  for (int j = 0; j < n; j += 2) t[j] = low_words(r[j], r[j + 1]), t[j + 1] = high_words(r[j], r[j + 1]);
  for (int j = 0; j < n; j += 4) {
    u[j] = low_pairs(t[j], t[j + 2]), u[j + 1] = high_pairs(t[j], t[j + 2]);
    u[j + 2] = low_pairs(t[j + 1], t[j + 3]), u[j + 3] = high_pairs(t[j + 1], t[j + 3]);
  }
}

// Word w of row k becomes word k of row w.
MONTELUX_INLINE void transpose(Row (&r)[16]) {
  Row u[16];
  transpose_squares(r, u);
  for (int c = 0; c < 4; ++c) {
    const Row even_low = even_fours(u[c], u[4 + c]), even_high = even_fours(u[8 + c], u[12 + c]);
    const Row odd_low = odd_fours(u[c], u[4 + c]), odd_high = odd_fours(u[8 + c], u[12 + c]);
    r[c] = even_fours(even_low, even_high), r[8 + c] = odd_fours(even_low, even_high);
    r[4 + c] = even_fours(odd_low, odd_high), r[12 + c] = odd_fours(odd_low, odd_high);
  }
}

// The rows of eight words with these numbers, two in each row.
template <std::size_t n>
MONTELUX_INLINE void load_pairs(const float* base, const std::uint32_t* low, const std::uint32_t* high, Row (&r)[n]) {
  for (std::size_t k = 0; k < n; ++k)
    r[k] = (Row)_mm512_insertf32x8(_mm512_castps256_ps512(_mm256_loadu_ps(base + std::size_t(low[k]) * 8)),
                                   _mm256_loadu_ps(base + std::size_t(high[k]) * 8), 1);
}

// Word w of the lower half of row k becomes word k of row w, and that of its upper half word 8 + k.
MONTELUX_INLINE void transpose_halves(Row (&r)[8]) {
  Row u[8];
  transpose_squares(r, u);
  for (int c = 0; c < 4; ++c) {
    r[c] = __builtin_shufflevector(u[c], u[4 + c], 0, 1, 2, 3, 16, 17, 18, 19, 8, 9, 10, 11, 24, 25, 26, 27);
    r[4 + c] = __builtin_shufflevector(u[c], u[4 + c], 4, 5, 6, 7, 20, 21, 22, 23, 12, 13, 14, 15, 28, 29, 30, 31);
  }
}

}  // namespace row_gather
#endif

// The words base[16 i] to base[16 i + 15] in every lane; every index must be in range, in idle lanes too.
template <class F>
MONTELUX_INLINE std::array<F, words_of_row> gather_rows(const float* base, Uint<F> i) {
  std::array<F, words_of_row> words;
#if defined(__AVX512F__)
  if constexpr (lanes_of<F> == 16) {
    std::array<std::uint32_t, 16> numbers;
    std::memcpy(numbers.data(), &i, sizeof numbers);
    row_gather::Row rows[16];
    for (std::size_t k = 0; k < 16; ++k) std::memcpy(&rows[k], base + std::size_t(numbers[k]) * 16, sizeof rows[k]);
    row_gather::transpose(rows);
    for (std::size_t w = 0; w < 16; ++w) words[w] = F(rows[w]);
    return words;
  }
#endif
  for (std::uint32_t w = 0; w < words_of_row; ++w)
    words[w] = gather(base + w, Uint<F>(i * std::uint32_t(words_of_row)));
  return words;
}
// The words base[8 i] to base[8 i + 7] in every lane, for three indices; every index must be in range, in idle lanes
// too.
template <class F>
MONTELUX_INLINE std::array<std::array<F, words_of_short_row>, 3> gather_short_rows(const float* base,
                                                                                   const std::array<Uint<F>, 3>& i) {
  std::array<std::array<F, words_of_short_row>, 3> words;
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  if constexpr (lanes_of<F> == 16) {
    std::array<std::array<std::uint32_t, 16>, 3> numbers;
    std::memcpy(numbers.data(), i.data(), sizeof numbers);
    row_gather::Row first_two[16], third[8];
    row_gather::load_pairs(base, numbers[0].data(), numbers[1].data(), first_two);
    row_gather::load_pairs(base, numbers[2].data(), numbers[2].data() + 8, third);
    row_gather::transpose(first_two);
    row_gather::transpose_halves(third);
    for (std::size_t w = 0; w < words_of_short_row; ++w)
      words[0][w] = F(first_two[w]), words[1][w] = F(first_two[8 + w]), words[2][w] = F(third[w]);
    return words;
  }
#endif
  const Uint<F> stride(std::uint32_t{words_of_short_row});
  for (const Uint<F>& number : i) prefetch(base, Uint<F>(number * stride), Mask<F>(true));
  for (std::size_t k = 0; k < 3; ++k)
    for (std::uint32_t w = 0; w < words_of_short_row; ++w) words[k][w] = gather(base + w, Uint<F>(i[k] * stride));
  return words;
}
// One row in all lanes.
template <class F>
MONTELUX_INLINE std::array<F, words_of_row> row_in_all_lanes(const float* base, std::uint32_t i) {
  std::array<F, words_of_row> words;
  for (std::size_t w = 0; w < words_of_row; ++w) words[w] = F(base[std::size_t(i) * words_of_row + w]);
  return words;
}

}  // namespace montelux
