// Images with margins, in which they are mirrored: what filters read of the pixels around each pixel.
#pragma once
#include <array>
#include <vector>

#include "denoise/weighted_sums.h"

namespace montelux {

// Tiles of the image that are filtered at once.
inline constexpr int tile_width = 64, tile_height = 8;
inline constexpr int patch = 1;  // differences of colours are means over 3 x 3 pixels
inline constexpr int padding = filter_reach + patch;

// A plane with a margin on all sides, in which the image is mirrored, or zero.
class PaddedPlane {
 public:
  PaddedPlane() = default;
  PaddedPlane(const Plane& plane, int width, int height, bool mirror = true);
  // Pixels from x on may be read beyond the image, up to the next whole tile and pack.
  const float* at(int x, int y) const { return values_.data() + index(x, y); }

 private:
  std::size_t index(int x, int y) const {
    return std::size_t(y + padding) * std::size_t(stride_) + std::size_t(x + padding);
  }
  int stride_ = 0;
  std::vector<float> values_;
};

using PaddedColors = std::array<PaddedPlane, rgb_size>;

struct PaddedFeature {
  std::array<PaddedPlane, 3> mean;
  PaddedPlane variance;  // summed over the components
};

struct PaddedHalf {
  PaddedColors color, variance;
  PaddedFeature albedo, normal;
  PaddedPlane mean_albedo;   // over the channels
  PaddedPlane exists;        // 1 for pixels of the image that have a pass, else 0
  PaddedPlane near_surface;  // 1 for pixels that show a surface, and those beside them, else 0
};
using PaddedImage = std::array<PaddedHalf, 2>;

PaddedImage padded_image(const NoisyImage& image, const DenoiseSettings& settings);

}  // namespace montelux
