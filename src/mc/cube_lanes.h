// A coordinate of many points of the cube, a pack of points at a time: what the functions that fill blocks share.
#pragma once
#include <cstring>

#include "math/lanes.h"
#include "mc/cube_points.h"

namespace montelux {

inline constexpr std::size_t cube_pack = std::size_t(native_lanes);
using CubeWords = Uints<native_lanes>;
typedef double CubeDoubles __attribute__((vector_size(8 * native_lanes)));

// The number in (0, 1) whose first 32 binary digits are `high` and next 20 those of `low`, half a unit up.
MONTELUX_INLINE CubeDoubles unit_doubles(CubeWords high, CubeWords low) {
  const CubeDoubles coarse = __builtin_convertvector(high.v, CubeDoubles);
  const CubeDoubles fine = __builtin_convertvector((low >> 12).v, CubeDoubles);
  return coarse * 0x1p-32 + (fine * 0x1p-52 + 0x1p-53);
}

// Calls numbers(i) -> CubeDoubles for points i, i + 1, ... of a coordinate; truncates the last pack.
template <class Function>
MONTELUX_INLINE void fill_coordinate(double* out, std::size_t count, Function numbers) {
  std::size_t i = 0;
  for (; i + cube_pack <= count; i += cube_pack) {
    const CubeDoubles x = numbers(i);
    std::memcpy(out + i, &x, sizeof x);
  }
  if (i < count) {
    const CubeDoubles x = numbers(i);
    std::memcpy(out + i, &x, (count - i) * sizeof(double));
  }
}

}  // namespace montelux
