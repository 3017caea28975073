#include "mc/cube_points.h"

#include <cmath>
#include <cstring>

#include "mc/halton.h"
#include "mc/lattice.h"
#include "mc/pmj02.h"
#include "mc/sobol.h"

namespace montelux {
namespace {

constexpr std::size_t width = std::size_t(native_lanes);
using Words = Uints<native_lanes>;
typedef double Doubles __attribute__((vector_size(8 * native_lanes)));

// The number in (0, 1) whose first 32 binary digits are `high` and next 20 those of `low`, half a unit up.
MONTELUX_INLINE Doubles unit_doubles(Words high, Words low) {
  const Doubles coarse = __builtin_convertvector(high.v, Doubles);
  const Doubles fine = __builtin_convertvector((low >> 12).v, Doubles);
  return coarse * 0x1p-32 + (fine * 0x1p-52 + 0x1p-53);
}

// Calls numbers(i) -> Doubles for points i, i + 1, ... of a coordinate; truncates the last pack.
template <class Function>
MONTELUX_INLINE void fill_coordinate(double* out, std::size_t count, Function numbers) {
  std::size_t i = 0;
  for (; i + width <= count; i += width) {
    const Doubles x = numbers(i);
    std::memcpy(out + i, &x, sizeof x);
  }
  if (i < count) {
    const Doubles x = numbers(i);
    std::memcpy(out + i, &x, (count - i) * sizeof(double));
  }
}

}  // namespace

CubeKey CubeKey::of(std::uint64_t seed, std::uint32_t pass) {
  const std::uint32_t low = std::uint32_t(seed), high = std::uint32_t(seed >> 32);
  const std::uint32_t mixed = mix_bits(low ^ mix_bits(high + 0x9e3779b9u));
  return CubeKey{mixed, mix_bits(high ^ mix_bits(low + 0x3c6ef372u))}.fork(pass);
}
CubeKey CubeKey::fork(std::uint32_t purpose) const {
  return {mix_bits(low ^ mix_bits(purpose * 0x85ebca6bu + 0x27d4eb2fu)), mix_bits(high + mix_bits(low + purpose))};
}

namespace {

// Uniform numbers of one coordinate at the positions first, first + 1, ... of a stream.
struct CoordinateStream {
  CubeKey key;
  MONTELUX_INLINE Doubles at(std::uint64_t index) const {
    // A pack that straddles a multiple of 2^32 wraps within its 2^32 numbers; blocks begin at multiples of the pack.
    const CubeKey part = index >> 32 == 0 ? key : key.fork(std::uint32_t(index >> 32));
    const Words place = Words(std::uint32_t(index)) + lane_index<NativeFloats>();
    const Words high = mix_bits(Words(Words(part.high) ^ mix_bits(Words(Words(part.low) + place * 0x9e3779b9u))));
    return unit_doubles(high, mix_bits(Words(high ^ (place + part.low))));
  }
};

}  // namespace

void fill_independent(CubeKey key, CubeBlock block) {
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CoordinateStream stream{key.fork(std::uint32_t(d))};
    fill_coordinate(block.out + d * block.count, block.count,
                    [&](std::size_t i) { return stream.at(block.first + i); });
  }
}

void fill_antithetic(CubeKey key, CubeBlock block) {
  const std::uint64_t first = block.first / 2, last = (block.first + block.count + 1) / 2;
  std::vector<double> half(std::size_t(last - first) * block.dimension);
  fill_independent(key, {block.dimension, first, std::size_t(last - first), half.data()});
  for (std::size_t d = 0; d < block.dimension; ++d)
    for (std::size_t i = 0; i < block.count; ++i) {
      const std::uint64_t index = block.first + i;
      const double x = half[d * std::size_t(last - first) + std::size_t(index / 2 - first)];
      block.out[d * block.count + i] = index % 2 == 0 ? x : 1 - x;
    }
}

void fill_sobol(CubeKey key, CubeBlock block) {
  const Words lanes = lane_index<NativeFloats>();
  constexpr int lane_bits = std::countr_zero(unsigned(native_lanes));
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey own = key.fork(std::uint32_t(d)), more = own.fork(1);
    const auto& columns = sobol_matrices[d];
    const auto digits_of = [&](std::uint32_t index) {
      std::uint32_t digits = 0;
      for (; index != 0; index &= index - 1) digits ^= columns[std::size_t(std::countr_zero(index))];
      return digits;
    };
    // The digits of a pack are those of its first point combined, by linearity, with those of the lanes.
    Words lane_digits = 0u;
    for (int k = 0; k < native_lanes; ++k) set_lane(lane_digits, k, digits_of(std::uint32_t(k)));
    const bool aligned = block.first % width == 0;
    std::uint32_t digits = digits_of(std::uint32_t(block.first));
    fill_coordinate(block.out + d * block.count, block.count, [&](std::size_t i) {
      Words x = 0u;
      const auto index = std::uint32_t(block.first + i);
      if (aligned) {
        x = Words(digits) ^ lane_digits;
        // From one pack to the next the index changes in its lowest bits, up to the first that becomes 1.
        for (std::uint32_t flip = (index >> lane_bits) ^ ((index >> lane_bits) + 1); flip != 0; flip &= flip - 1)
          digits ^= columns[std::size_t(lane_bits + std::countr_zero(flip)) & 31];
      } else {
        for (int k = 0; k < native_lanes; ++k) set_lane(x, k, digits_of(index + std::uint32_t(k)));
      }
      const Words scrambled = reverse_bits(scramble_upwards(x, Words(own.low))) ^ Words(own.high);
      const Words rest = mix_bits(Words((Words(index) + lanes) * 0x9e3779b9u ^ Words(more.low)));
      return unit_doubles(scrambled, rest);
    });
  }
}

void fill_lattice(CubeKey key, CubeBlock block) {
  const Words lanes = lane_index<NativeFloats>();
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey own = key.fork(std::uint32_t(d));
    const std::uint32_t z = lattice_generator[d];
    fill_coordinate(block.out + d * block.count, block.count, [&](std::size_t i) {
      const Words index = Words(std::uint32_t(block.first + i)) + lanes;
      return unit_doubles(lattice_word(index, Words(z), Words(own.high)), Words(own.low));
    });
  }
}

void fill_pmj02(CubeKey key, CubeBlock block) {
  const Words lanes = lane_index<NativeFloats>();
  const int bits = int(std::bit_width(block.first + block.count - 1));
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey pair = key.fork(std::uint32_t(d / 2)), own = pair.fork(std::uint32_t(1 + d % 2));
    fill_coordinate(block.out + d * block.count, block.count, [&](std::size_t i) {
      const Words index = Words(std::uint32_t(block.first + i)) + lanes;
      const Words first = pmj02_order(index, Words(pair.high));
      const Words place = d % 2 == 0 ? first : multiply_by_pascal(first);
      const Words digits = pmj02_digits(place, bits, Words(own.low));
      return unit_doubles(reverse_bits(digits), mix_bits(Words(place ^ Words(own.high))));
    });
  }
}

void fill_halton(CubeKey key, CubeBlock block) {
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey own = key.fork(std::uint32_t(d));
    for (std::size_t i = 0; i < block.count; ++i)
      block.out[d * block.count + i] =
          scrambled_radical_inverse_double(std::uint32_t(block.first + i), halton_bases[d], ~0u, own.low);
  }
}

void fill_latin(CubeKey key, std::uint64_t n, CubeBlock block) {
  const Words lanes = lane_index<NativeFloats>();
  const double scale = 1 / double(n);
  const Words last(std::uint32_t(n - 1));
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey own = key.fork(std::uint32_t(d));
    const CoordinateStream jitter{own.fork(1)};
    fill_coordinate(block.out + d * block.count, block.count, [&](std::size_t i) {
      const Words index = min(Words(Words(std::uint32_t(block.first + i)) + lanes), last);
      const Words part = permute(index, std::uint32_t(n), Words(own.low));
      return (__builtin_convertvector(part.v, Doubles) + jitter.at(block.first + i)) * scale;
    });
  }
}

GridShape GridShape::of(std::size_t dimension, std::uint64_t n) {
  GridShape shape;
  auto parts = std::uint32_t(std::pow(double(n), 1 / double(dimension)) + 1e-9);
  shape.parts.assign(dimension, std::max(1u, parts));
  for (std::uint32_t p : shape.parts) shape.boxes *= p;
  for (std::uint32_t& p : shape.parts) {
    if (shape.boxes / p * (p + 1) > n) break;
    shape.boxes = shape.boxes / p * (p + 1);
    ++p;
  }
  return shape;
}

void fill_grid(CubeKey key, const GridShape& shape, CubeBlock block) {
  fill_independent(key, block);
  std::vector<std::uint64_t> place(block.count);
  for (std::size_t i = 0; i < block.count; ++i) place[i] = block.first + i;
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const std::uint32_t parts = shape.parts[d];
    double* x = block.out + d * block.count;
    for (std::size_t i = 0; i < block.count; ++i) {
      if (block.first + i < shape.boxes) x[i] = (double(place[i] % parts) + x[i]) / double(parts);
      place[i] /= parts;
    }
  }
}

void fold(std::span<double> x) {
  for (double& v : x) v = 1 - std::abs(2 * v - 1);
}

}  // namespace montelux
