#include "mc/pmj02.h"

#include "mc/cube_lanes.h"

namespace montelux {

void fill_pmj02(CubeKey key, CubeBlock block) {
  const CubeWords lanes = lane_index<NativeFloats>();
  const int bits = int(std::bit_width(block.first + block.count - 1));
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey pair = key.fork(std::uint32_t(d / 2)), own = pair.fork(std::uint32_t(1 + d % 2));
    fill_coordinate(block.out + d * block.count, block.count, [&](std::size_t i) {
      const CubeWords index = CubeWords(std::uint32_t(block.first + i)) + lanes;
      const CubeWords first = pmj02_order(index, CubeWords(pair.high));
      const CubeWords place = d % 2 == 0 ? first : multiply_by_pascal(first);
      const CubeWords digits = pmj02_digits(place, bits, CubeWords(own.low));
      return unit_doubles(reverse_bits(digits), mix_bits(CubeWords(place ^ CubeWords(own.high))));
    });
  }
}

}  // namespace montelux
