// Radical inverses in prime bases with nested random digit permutations: the scrambled Halton sequence.
#pragma once
#include <array>

#include "mc/cube_points.h"
#include "mc/digital.h"

namespace montelux {

inline constexpr std::uint32_t halton_dimensions = 128;

// The first primes, one base for each dimension.
inline constexpr std::array<std::uint32_t, halton_dimensions> halton_bases = [] {
  std::array<std::uint32_t, halton_dimensions> bases{};
  std::uint32_t candidate = 2;
  for (auto& base : bases) {
    const auto is_prime = [](std::uint32_t n) {
      for (std::uint32_t k = 2; k * k <= n; ++k)
        if (n % k == 0) return false;
      return true;
    };
    while (!is_prime(candidate)) ++candidate;
    base = candidate++;
  }
  return bases;
}();

// The digits of the index mirrored at the point, each permuted by a random permutation that depends on the digits
// before it (Owen 1995). The digits that distinguish the indices below `count` are computed; later ones differ from
// point to point anyway and are random numbers.
inline double scrambled_radical_inverse_double(std::uint32_t index, std::uint32_t base, std::uint32_t count,
                                               std::uint32_t key) {
  double value = 0, scale = 1;
  for (std::uint64_t distinct = 1; distinct < count; distinct *= base) {
    const std::uint32_t digit = index % base;
    scale /= base;
    const std::uint64_t factor = 1u + (std::uint64_t(mix_bits(key)) * (base - 1u) >> 32);
    const std::uint64_t offset = std::uint64_t(mix_bits(key ^ 0x85ebca6bu)) * base >> 32;
    value += scale * double((factor * digit + offset) % base);
    key = mix_bits(key + (digit + 1u) * 0x9e3779b9u);
    index /= base;
  }
  value += scale * double(unit_float<float>(mix_bits(key ^ (index * 0x85ebca6bu))));
  return value;
}
inline float scrambled_radical_inverse(std::uint32_t index, std::uint32_t base, std::uint32_t count,
                                       std::uint32_t key) {
  return std::min(float(scrambled_radical_inverse_double(index, base, count, key)), one_minus_epsilon);
}

// The scrambled radical inverse in every lane; the base is that of the dimension (below halton_dimensions).
template <class F>
F halton(Uint<F> index, Uint<F> dimension, std::uint32_t count, Uint<F> key) {
  F result = 0.0f;
  for (int k = 0; k < lanes_of<F>; ++k)
    set_lane(result, k,
             scrambled_radical_inverse(lane(index, k), halton_bases[lane(dimension, k)], count, lane(key, k)));
  return result;
}

// The Halton sequence with nested random digits. Indices below 2^32, dimensions up to halton_dimensions.
void fill_halton(CubeKey key, CubeBlock block);

}  // namespace montelux
