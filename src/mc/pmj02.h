// Progressive multi-jittered (0,2)-points (Christensen, Kensler and Kilpatrick 2018), computed one by one from digits.
#pragma once
#include "mc/cube_points.h"
#include "mc/digital.h"

namespace montelux {

// The order of the sequence: a random bijection that keeps 0 and maps 0..2^k-1 onto itself for every k, so that each
// key has another random pairing of the new points of a doubling with the old ones.
template <class U>
MONTELUX_INLINE U pmj02_order(U index, U key) {
  return reverse_bits(U(scramble_upwards(reverse_bits(index), key) ^ scramble_upwards(U(0u), key)));
}

// The digits, first one lowest, of a coordinate of the point `index` < 2^bits. When the sequence doubles beyond 2^j
// points, the new point shares the first j digits of the old one that it is paired with, has the opposite next digit,
// and random later digits (Helmer, Christensen and Kensler 2021, "Stochastic Generation of (t,s) Sample Sequences",
// section 4): digit j is that of the index, flipped by the random bit j of the point given by the j lower digits.
template <class U>
MONTELUX_INLINE U pmj02_digits(U index, int bits, U key) {
  const auto drawn = [&](U point) { return mix_bits(U(point * U(0x9e3779b9u) + key)); };
  const std::uint32_t known = bits < 32 ? (1u << bits) - 1u : ~0u;
  U flips = drawn(index) & U(~known);
  for (int j = 0; j < bits; ++j) flips = flips | (drawn(U(index & U((1u << j) - 1u))) & U(1u << j));
  return index ^ flips;
}

// Progressive multi-jittered (0,2)-sequences, one for each pair of dimensions. Indices below 2^32.
void fill_pmj02(CubeKey key, CubeBlock block);

}  // namespace montelux
