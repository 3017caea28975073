// Images on lights.
#pragma once
#include <algorithm>
#include <vector>

#include "color/rgb.h"
#include "math/vec.h"

namespace montelux {

// Linear colours, row by row from the top left.
struct LightImage {
  int width = 0, height = 0;
  std::vector<Rgb> texels;

  const Rgb& at(int x, int y) const {
    return texels[std::size_t(std::clamp(y, 0, height - 1)) * std::size_t(width) +
                  std::size_t(std::clamp(x, 0, width - 1))];
  }
  // The texel at uv in [0, 1)^2, v downward.
  const Rgb& nearest(Vec2f uv) const { return at(int(uv.x * float(width)), int(uv.y * float(height))); }
  // Bilinear between texel centres; constant beyond the outermost.
  Rgb bilinear(Vec2f uv) const {
    float x = std::clamp(uv.x, 0.0f, 1.0f) * float(width) - 0.5f,
          y = std::clamp(uv.y, 0.0f, 1.0f) * float(height) - 0.5f;
    float fx = floor(x), fy = floor(y), dx = x - fx, dy = y - fy;
    int i = int(fx), j = int(fy);
    return (at(i, j) * (1 - dx) + at(i + 1, j) * dx) * (1 - dy) +
           (at(i, j + 1) * (1 - dx) + at(i + 1, j + 1) * dx) * dy;
  }
  Rgb mean() const {
    double sum[rgb_size] = {};
    for (const Rgb& t : texels)
      for (int i = 0; i < rgb_size; ++i) sum[i] += t.c[i];
    Rgb r;
    for (int i = 0; i < rgb_size; ++i) r.c[i] = float(sum[i] / double(std::max<std::size_t>(texels.size(), 1)));
    return r;
  }
};

}  // namespace montelux
