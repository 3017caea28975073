#include "mc/cube_points.h"

#include <cstring>

#include "mc/random.h"

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

// Calls numbers(i) -> Doubles for points i, i + 1, ... of a coordinate, packs that reach over the end cut off.
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

void fill_independent(CubeKey key, CubeBlock block) {
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey own = key.fork(std::uint32_t(d));
    fill_coordinate(block.out + d * block.count, block.count, [&](std::size_t i) {
      const std::uint64_t index = block.first + i;
      // A pack that straddles a multiple of 2^32 would wrap; blocks begin at multiples of the pack, so none does.
      const CubeKey part = index >> 32 == 0 ? own : own.fork(std::uint32_t(index >> 32));
      const Words place = Words(std::uint32_t(index)) + lane_index<NativeFloats>();
      const Words high = mix_bits(Words(Words(part.high) ^ mix_bits(Words(Words(part.low) + place * 0x9e3779b9u))));
      return unit_doubles(high, mix_bits(Words(high ^ (place + part.low))));
    });
  }
}

}  // namespace montelux
