// Gradient noise in space and sums of it over octaves. Values are reproducible on every machine.
#pragma once
#include "math/functions.h"

namespace montelux {

// Perlin 2002, "Improving Noise": zero at points with integer coordinates, mean about 0, magnitude below about 1;
// repeats every 256 units.
float gradient_noise(Vec3f p);
// The sum over octaves i of roughness^i noise(1.99^i p), without a limit by the footprint: sampling averages it.
float fractional_brownian_motion(Vec3f p, float roughness, int octaves);
// The same sum for the magnitude of the noise.
float turbulence(Vec3f p, float roughness, int octaves);

}  // namespace montelux
