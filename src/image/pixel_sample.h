// What one sample of a pixel is, and which pixels are meant: the words that integrators, film and scheduler share.
#pragma once
#include <cstdint>

#include "color/spectrum.h"
#include "math/vec.h"

namespace montelux {

// Pixels x0 <= x < x1, y0 <= y < y1 of the full image; row 0 on top.
struct PixelBounds {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  int area() const { return width() * height(); }
  bool operator==(const PixelBounds&) const = default;
};

// What the first surface of a camera path shows; coverage 0: the path left the scene.
struct Features {
  Rgb albedo{};      // directional albedo: the weight of one scattered direction, whose mean it is
  Vec3f normal{};    // shading normal, world space, facing the camera
  Vec3f position{};  // world space
  float depth = 0;   // distance along the ray from the camera's origin
  float coverage = 0;
  std::uint32_t object = 0;  // number of the object from 1; 0: none
};

// One sample of a pixel: what an integrator returns.
struct PixelSample {
  Rgb radiance{};
  Features features;
};

}  // namespace montelux
