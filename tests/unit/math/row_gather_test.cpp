// Rows of sixteen and of eight words in every lane.
#include "math/row_gather.h"

#include <gtest/gtest.h>

#include <vector>

namespace montelux {
namespace {

// Word w of row i is 100 i + w, so that no two are alike.
template <class F>
void expect_rows(const std::vector<float>& table, const Uint<F>& numbers) {
  const std::array<F, words_of_row> words = gather_rows<F>(table.data(), numbers);
  for (int w = 0; w < words_of_row; ++w)
    for (int k = 0; k < lanes_of<F>; ++k)
      ASSERT_EQ(lane(words[std::size_t(w)], k), table[lane(numbers, k) * words_of_row + std::uint32_t(w)])
          << "word " << w << ", lane " << k;
}

// The same for three rows of eight words.
template <class F>
void expect_short_rows(const std::vector<float>& table, const std::array<Uint<F>, 3>& numbers) {
  const auto words = gather_short_rows<F>(table.data(), numbers);
  for (std::size_t i = 0; i < 3; ++i)
    for (int w = 0; w < words_of_short_row; ++w)
      for (int k = 0; k < lanes_of<F>; ++k)
        ASSERT_EQ(lane(words[i][std::size_t(w)], k), table[lane(numbers[i], k) * words_of_short_row + std::uint32_t(w)])
            << "row " << i << ", word " << w << ", lane " << k;
}

TEST(RowGather, gives_every_lane_its_own_row) {
  constexpr std::uint32_t rows = 37;
  std::vector<float> table;
  for (std::uint32_t i = 0; i < rows; ++i)
    for (std::uint32_t w = 0; w < words_of_row; ++w) table.push_back(float(100 * i + w));
  for (std::uint32_t round = 0; round < 50; ++round) {
    Uint<NativeFloats> numbers;
    for (int k = 0; k < native_lanes; ++k) set_lane(numbers, k, (7 * round + 11 * std::uint32_t(k * k)) % rows);
    expect_rows<NativeFloats>(table, numbers);
    expect_rows<Floats<4>>(table, Uints<4>(round % rows));
    expect_rows<float>(table, round % rows);
    // There are twice as many short rows.
    const Uint<NativeFloats> next = numbers + Uint<NativeFloats>(rows), first = numbers ^ Uint<NativeFloats>(1u);
    expect_short_rows<NativeFloats>(table, {numbers, next, first});
    expect_short_rows<Floats<4>>(table, {Uints<4>(round % rows), Uints<4>(rows), Uints<4>(0u)});
    expect_short_rows<float>(table, {round % rows, rows, 2 * rows - 1});
    const std::array<NativeFloats, words_of_row> same = row_in_all_lanes<NativeFloats>(table.data(), round % rows);
    for (int w = 0; w < words_of_row; ++w)
      ASSERT_EQ(lane(same[std::size_t(w)], native_lanes - 1), float(100 * (round % rows) + std::uint32_t(w)));
  }
}

// The words may be integers, which as floats are not numbers, or are so small that arithmetic would make them zero.
TEST(RowGather, keeps_the_bits_of_every_word) {
  std::vector<std::uint32_t> table;
  for (std::uint32_t i = 0; i < 2 * words_of_row; ++i) table.push_back(i % 3 == 0 ? i : 0x7f800001u + 77u * i);
  const auto words = gather_rows<NativeFloats>(reinterpret_cast<const float*>(table.data()),
                                               lane_index<NativeFloats>() & Uints<native_lanes>(1u));
  for (std::uint32_t w = 0; w < words_of_row; ++w)
    for (int k = 0; k < native_lanes; ++k)
      ASSERT_EQ(lane(float_bits(words[w]), k), table[std::uint32_t(k & 1) * words_of_row + w]);
}

}  // namespace
}  // namespace montelux
