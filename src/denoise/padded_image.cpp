#include "denoise/padded_image.h"

#include <algorithm>

#include "denoise/box_mean.h"
#include "denoise/units.h"
#include "film/max_around.h"
#include "math/functions.h"
#include "math/lanes.h"

namespace montelux {

PaddedPlane::PaddedPlane(const Plane& plane, int width, int height, bool mirror)
    : stride_(width + 2 * padding + tile_width + native_lanes),
      values_(std::size_t(stride_) * std::size_t(height + 2 * padding + tile_height)) {
  const auto inside = [](int i, int n) {
    const int period = 2 * n, k = ((i % period) + period) % period;
    return k < n ? k : period - 1 - k;
  };
  const int margin = mirror ? padding : 0;
  for (int y = -margin; y < height + margin; ++y) {
    const auto from = plane.begin() + std::ptrdiff_t(inside(y, height)) * width;
    const auto to = values_.begin() + std::ptrdiff_t(index(0, y));
    std::copy_n(from, width, to);
    for (int x = 0; x < margin; ++x) {
      to[-1 - x] = from[inside(-1 - x, width)];
      to[width + x] = from[inside(width + x, width)];
    }
  }
}

namespace {

template <std::size_t n>
std::array<PaddedPlane, n> padded(const std::array<Plane, n>& planes, int width, int height) {
  std::array<PaddedPlane, n> all;
  for (std::size_t i = 0; i < n; ++i) all[i] = PaddedPlane(planes[i], width, height);
  return all;
}

// The variance of a half, half of it that of the 3 x 3 pixels: that of single pixels is known too badly.
ColorPlanes variance_of_half(const NoisyImage& image, const HalfPlanes& half) {
  ColorPlanes variance = image.variance;
  for (Plane& plane : variance) {
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = half.share[i] > 0 ? plane[i] / half.share[i] : 0;
    const Plane around = box_mean(plane, image.width, image.height, 1);
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = 0.5f * (plane[i] + around[i]);
  }
  return variance;
}

// A feature of a half. The variance of the mean over all passes is known by how much both halves differ, here over 5 x
// 5 pixels.
PaddedFeature padded_feature(const NoisyImage& image, std::size_t half, std::array<Plane, 3> HalfPlanes::*feature) {
  const auto& [a, b] = image.halves;
  const HalfPlanes& own = image.halves[half];
  Plane variance(image.pixels());
  for (std::size_t i = 0; i < variance.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      variance[i] += a.share[i] * b.share[i] * square((a.*feature)[c][i] - (b.*feature)[c][i]);
  variance = box_mean(variance, image.width, image.height, 2);
  for (std::size_t i = 0; i < variance.size(); ++i) variance[i] = own.share[i] > 0 ? variance[i] / own.share[i] : 0;
  return {padded(own.*feature, image.width, image.height), PaddedPlane(variance, image.width, image.height)};
}

// A pixel shows a surface if its mean normal is not zero.
Plane near_surface(const NoisyImage& image, const HalfPlanes& half) {
  Plane surface(image.pixels());
  for (const Plane& component : half.normal)
    for (std::size_t i = 0; i < surface.size(); ++i)
      if (component[i] != 0) surface[i] = 1;
  return max_around(surface, image.width, 1);
}

Plane mean_albedo(const HalfPlanes& half) {
  Plane mean(half.share.size());
  for (const Plane& channel : half.albedo)
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += channel[i] / float(rgb_size);
  return mean;
}

}  // namespace

PaddedImage padded_image(const NoisyImage& image, const DenoiseSettings& settings) {
  const int w = image.width, h = image.height;
  PaddedImage both;
  for_each_unit(2, settings, [&](std::size_t k) {
    const HalfPlanes& half = image.halves[k];
    Plane exists(image.pixels());
    for (std::size_t i = 0; i < exists.size(); ++i) exists[i] = half.share[i] > 0 ? 1.0f : 0.0f;
    both[k] = {padded(half.color, w, h),
               padded(variance_of_half(image, half), w, h),
               padded_feature(image, k, &HalfPlanes::albedo),
               padded_feature(image, k, &HalfPlanes::normal),
               PaddedPlane(mean_albedo(half), w, h),
               PaddedPlane(exists, w, h, false),
               PaddedPlane(near_surface(image, half), w, h)};
  });
  return both;
}

}  // namespace montelux
