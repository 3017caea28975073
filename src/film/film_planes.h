// The state of a film at one time, as planes of one number per pixel.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "image/pixel_sample.h"

namespace montelux {

class Film;

using Plane = std::vector<float>;
using ColorPlanes = std::array<Plane, rgb_size>;

// Planes hold the rows of the bounds from the top.
struct FilmPlanes {
  explicit FilmPlanes(const PixelBounds& bounds);
  // Copies the pixels of a part, to which no other thread may write meanwhile.
  void copy(const Film& film, const PixelBounds& part);

  std::size_t index(int x, int y) const {
    return std::size_t(y - bounds.y0) * std::size_t(bounds.width()) + std::size_t(x - bounds.x0);
  }

  PixelBounds bounds;
  Rgb max_chance_radiance{};           // as Film has it
  ColorPlanes mean, variance;          // over passes; of the mean
  ColorPlanes albedo;                  // mean over samples, as in the following planes
  std::array<Plane, 3> normal;         // world space
  Plane emission;                      // mean of the channels
  Plane coverage;                      // share of the samples that hit a surface
  Plane samples;                       // their number
  Plane emission_rays;                 // the number of rays that show the emission
  Plane object;                        // number of the object, 0: none
  Plane first_half, second_half;       // mean over one half of the passes and over the other, mean of the channels
  std::vector<std::uint32_t> passes;   // their number
  std::vector<std::uint8_t> expected;  // 1: the pixel is sampled and has a finite sample
};

// 1 for pixels of which it is known that emitters in view cover all of them or nothing: those to which an integrator
// that traces more rays for lamps has given none; else 0.
std::vector<std::uint8_t> known_covers_of(const FilmPlanes& planes);

}  // namespace montelux
