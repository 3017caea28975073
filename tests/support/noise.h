// What integrators of made-up noise share: a test that knows the noise knows what must be measured.
#pragma once
#include <cmath>

#include "integrator/integrator.h"

namespace montelux::test {

// f(i, sampler) for each sample of a tile, in the order of the pixels, with independent numbers for each. `together`:
// all pixels have the same.
template <class Function>
void for_each_noise(const TilePass& pass, bool together, Function f) {
  std::size_t i = 0;
  for (int y = pass.tile.y0; y < pass.tile.y1; ++y)
    for (int x = pass.tile.x0; x < pass.tile.x1; ++x)
      for (std::uint32_t k = 0; k < pass.points.samples_per_pass; ++k, ++i)
        f(i,
          Sampler<float>({PointSetKind::independent, pass.points.seed, pass.points.pass, pass.points.samples_per_pass},
                         together ? 0u : std::uint32_t(x), together ? 0u : std::uint32_t(y), k));
}

// Uniform, of mean 0 and this standard deviation.
inline float noise(const Sampler<float>& sampler, std::uint32_t dimension, float sigma) {
  return sigma * std::sqrt(12.0f) * (sampler.get1(dimension) - 0.5f);
}

}  // namespace montelux::test
