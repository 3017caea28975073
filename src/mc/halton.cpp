#include "mc/halton.h"

#include "mc/cube_lanes.h"

namespace montelux {

void fill_halton(CubeKey key, CubeBlock block) {
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey own = key.fork(std::uint32_t(d));
    for (std::size_t i = 0; i < block.count; ++i)
      block.out[d * block.count + i] =
          scrambled_radical_inverse_double(std::uint32_t(block.first + i), halton_bases[d], ~0u, own.low);
  }
}

}  // namespace montelux
