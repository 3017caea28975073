// What a film knows at one moment, as planes of one number a pixel.
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
  // Copies the pixels of a part, which only the caller may write to meanwhile.
  void copy(const Film& film, const PixelBounds& part);

  std::size_t index(int x, int y) const {
    return std::size_t(y - bounds.y0) * std::size_t(bounds.width()) + std::size_t(x - bounds.x0);
  }

  PixelBounds bounds;
  ColorPlanes mean, variance;          // over passes; of the mean
  ColorPlanes albedo;                  // means over samples, as are those that follow
  std::array<Plane, 3> normal;         // world space
  Plane emission;                      // mean of the channels
  Plane object;                        // number of the object, 0: none
  Plane first_half, second_half;       // means over half of the passes and over the rest, mean of the channels
  std::vector<std::uint8_t> passes;    // 0, 1, or 2 for two and more
  std::vector<std::uint8_t> expected;  // 1 where the pixel could have passes: sampled, with a finite sample
};

}  // namespace montelux
