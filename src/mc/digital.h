// Digital nets in base 2: bit matrices applied to an index, and Owen's nested scrambling by a hash.
#pragma once
#include <algorithm>

#include "mc/random.h"

namespace montelux {

// Reverses the 32 bits.
template <class U>
MONTELUX_INLINE U reverse_bits(U x) {
  x = ((x >> 1) & U(0x55555555u)) | ((x & U(0x55555555u)) << 1);
  x = ((x >> 2) & U(0x33333333u)) | ((x & U(0x33333333u)) << 2);
  x = ((x >> 4) & U(0x0f0f0f0fu)) | ((x & U(0x0f0f0f0fu)) << 4);
  x = ((x >> 8) & U(0x00ff00ffu)) | ((x & U(0x00ff00ffu)) << 8);
  return (x >> 16) | (x << 16);
}

// A random bijection in which every bit depends only on itself and on lower bits: on a bit-reversed fraction this is
// Owen's nested uniform scrambling (Laine and Karras 2011; multipliers by N. Vegdahl 2021).
template <class U>
MONTELUX_INLINE U scramble_upwards(U x, U key) {
  x = x ^ (x * U(0x3d20adeau));
  x = x + key;
  x = x * ((key >> 16) | U(1u));
  x = x ^ (x * U(0x05526c56u));
  return x ^ (x * U(0x53a22864u));
}

// A random bijection of indices that maps every aligned block of 2^k indices onto an aligned block (Burley 2020,
// "Practical Hash-based Owen Scrambling").
template <class U>
MONTELUX_INLINE U shuffle_index(U index, U key) {
  return reverse_bits(scramble_upwards(reverse_bits(index), key));
}

// The second generator matrix of the (0,2)-sequence, Pascal's triangle modulo 2, in bit-reversed digits: bit i of the
// result is the sum of the bits j of x whose number contains that of i (Lucas), so five steps suffice.
template <class U>
MONTELUX_INLINE U multiply_by_pascal(U x) {
  x = x ^ ((x >> 1) & U(0x55555555u));
  x = x ^ ((x >> 2) & U(0x33333333u));
  x = x ^ ((x >> 4) & U(0x0f0f0f0fu));
  x = x ^ ((x >> 8) & U(0x00ff00ffu));
  return x ^ ((x >> 16) & U(0x0000ffffu));
}

// The fraction in [0, 1) whose binary digits, first digit lowest, are x.
template <class F>
MONTELUX_INLINE F fraction_of_reversed(Uint<F> x) {
  return unit_float<F>(reverse_bits(x));
}

// A random permutation of 0..n-1, selected by the key, at `index` < n; n >= 1. Walks cycles of a random bijection of
// the next power of two (Kensler 2013, "Correlated Multi-Jittered Sampling", section 5).
template <class U>
MONTELUX_INLINE U permute(U index, std::uint32_t n, U key) {
  const std::uint32_t mask = std::bit_ceil(n) - 1u;
  const int half = std::max(1, std::popcount(mask) / 2);
  U x = index;
  auto outside = index == index;
  do {
    U y = x;
    for (std::uint32_t round = 0; round < 4; ++round) {
      U k = mix_bits(U(key + U(round * 0x9e3779b9u)));
      y = ((y ^ k) * ((k >> 16) | U(1u))) & U(mask);
      y = y ^ (y >> half);
    }
    x = select(outside, y, x);
    outside = x >= U(n);
  } while (any(outside));
  return x;
}

}  // namespace montelux
