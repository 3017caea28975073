#include "denoise/reproject.h"

#include <cmath>
#include <limits>
#include <optional>

namespace montelux {

namespace {

// The pixel in which the centre of (x, y) was.
std::optional<std::size_t> earlier_pixel(const MotionPlanes& motion, int width, int height, int x, int y) {
  const auto i = std::size_t(y) * std::size_t(width) + std::size_t(x);
  const float to_x = std::round(float(x) + motion.x[i]), to_y = std::round(float(y) - motion.y[i]);
  if (!(to_x >= 0 && to_x < float(width) && to_y >= 0 && to_y < float(height))) return std::nullopt;
  return std::size_t(to_y) * std::size_t(width) + std::size_t(to_x);
}

}  // namespace

NoisyImage reprojected(const NoisyImage& earlier, const MotionPlanes& motion) {
  NoisyImage image(earlier.width, earlier.height);
  for (const NoisyLayer& layer : earlier.layers) image.layers.emplace_back(image.pixels(), layer.knows_variance());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto from = earlier_pixel(motion, image.width, image.height, x, y);
      if (!from) continue;  // shares are 0
      const auto i = std::size_t(y) * std::size_t(image.width) + std::size_t(x);
      for (std::size_t h = 0; h < 2; ++h) {
        const HalfPlanes& half = earlier.halves[h];
        HalfPlanes& to = image.halves[h];
        to.share[i] = half.share[*from];
        for (std::size_t c = 0; c < 3; ++c) {
          to.color[c][i] = half.color[c][*from], to.albedo[c][i] = half.albedo[c][*from];
          to.emission[c][i] = half.emission[c][*from], to.normal[c][i] = half.normal[c][*from];
        }
      }
      for (std::size_t c = 0; c < rgb_size; ++c) {
        image.variance[c][i] = earlier.variance[c][*from];
        for (std::size_t k = 0; k < image.layers.size(); ++k) {
          const NoisyLayer& layer = earlier.layers[k];
          NoisyLayer& to = image.layers[k];
          for (std::size_t h = 0; h < 2; ++h) to.halves[h][c][i] = layer.halves[h][c][*from];
          if (layer.knows_variance()) to.variance[c][i] = layer.variance[c][*from];
        }
      }
    }
  return image;
}

MotionPlanes composed(const MotionPlanes& motion, const MotionPlanes& before, int width, int height) {
  MotionPlanes both = motion;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto i = std::size_t(y) * std::size_t(width) + std::size_t(x);
      if (const auto from = earlier_pixel(motion, width, height, x, y))
        both.x[i] += before.x[*from], both.y[i] += before.y[*from];
      else
        both.x[i] = both.y[i] = std::numeric_limits<float>::quiet_NaN();
    }
  return both;
}

}  // namespace montelux
