// A floor under a square light with a square blocker between them, all parallel, so that the irradiance has a closed
// form: the part of the light that the blocker hides is a rectangle again.
#pragma once
#include <cstdint>
#include <vector>

#include "lab/report/report.h"

namespace montelux::lab {

// Where the numbers for the points of the light come from.
enum class Pattern : std::uint8_t { fixed, grid, random, stratified, quasi_random };
// What is sampled: points of the light, or directions.
enum class Sampling : std::uint8_t { area, solid_angle, projected_solid_angle };

struct FloorSettings {
  Pattern pattern = Pattern::random;
  Sampling sampling = Sampling::area;
  std::uint32_t eye_rays = 4, shadow_rays = 1;
  bool wrong_factor = false;  // directions uniform in solid angle with the factor of the projected solid angle
};

// The floor from -2 to 2 in both directions at height 0, in size x size pixels, row by row. Radiance is 1.
struct FloorScene {
  std::uint32_t size = 64;

  // One estimate of the mean irradiance of a pixel; shadow_rays is a square number where the pattern has a grid.
  double pixel(const FloorSettings& settings, std::uint32_t pixel, std::uint32_t seed, std::uint32_t pass) const;
  // The same from the closed form, averaged over the pixel by quadrature.
  std::vector<double> reference() const;
};

// The irradiance at a point of the floor: of the light without what the blocker hides.
double floor_irradiance(double x, double y);

// Values from 0 to `white` as a gray picture with the transfer function of sRGB.
Picture gray_picture(const std::vector<double>& values, int width, double white);

}  // namespace montelux::lab
