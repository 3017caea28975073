// The numbers of integrators that stand for noise.
#pragma once
#include "integrator/integrator.h"
#include "mc/random.h"

namespace montelux::test {

// A stream of its own for each seed, pass and tile.
inline RandomStream<float> tile_numbers(const TilePass& pass, std::uint32_t seed) {
  const std::uint32_t tile = std::uint32_t(1000 * pass.tile.y0 + pass.tile.x0);
  return RandomStream<float>(mix_bits(pass.points.pass + 1) ^ mix_bits(seed + 77), tile);
}

}  // namespace montelux::test
