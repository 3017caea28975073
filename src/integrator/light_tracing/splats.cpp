#include "integrator/light_tracing/splats.h"

#include <algorithm>

namespace montelux {

void SplatPlane::add(Vec2f raster, const Rgb& value) {
  using F = NativeFloats;
  const Vec2f radius = filter_.radius();
  const auto first = [](float at, float reach, int low) { return std::max(int(std::ceil(at - reach - 0.5f)), low); };
  const auto last = [](float at, float reach, int high) {
    return std::min(int(std::floor(at + reach - 0.5f)), high - 1);
  };
  const int x0 = first(raster.x, radius.x, bounds_.x0), x1 = last(raster.x, radius.x, bounds_.x1);
  const int y0 = first(raster.y, radius.y, bounds_.y0), y1 = last(raster.y, radius.y, bounds_.y1);
  if (x0 > x1 || y0 > y1) return;
  const int across = x1 - x0 + 1, count = across * (y1 - y0 + 1);
  float largest = 0;  // of the components, and not a number where one is not
  for (int i = 0; i < rgb_size; ++i) largest += std::abs(value.c[i]);
  for (int begin = 0; begin < count; begin += lanes_of<F>) {
    Vec2<F> offset{F(0.0f), F(0.0f)};
    const int n = std::min(count - begin, lanes_of<F>);
    for (int k = 0; k < n; ++k) {
      set_lane(offset.x, k, raster.x - (float(x0 + (begin + k) % across) + 0.5f));
      set_lane(offset.y, k, raster.y - (float(y0 + (begin + k) / across) + 0.5f));
    }
    const F weight = filter_.evaluate(offset);
    for (int k = 0; k < n; ++k) {
      const float w = lane(weight, k);
      const int x = x0 + (begin + k) % across, y = y0 + (begin + k) / across;
      Pixel& pixel = pixels_[std::size_t((y - bounds_.y0) * bounds_.width() + x - bounds_.x0)];
      if (!(largest * std::abs(w) < ExactSum::largest)) {
        pixel.broken.store(true, std::memory_order_relaxed);
        continue;
      }
      for (int i = 0; i < rgb_size; ++i) pixel.sums[i].add(value.c[i] * w);
    }
  }
}

Rgb SplatPlane::take(int x, int y) {
  Pixel& pixel = pixels_[std::size_t((y - bounds_.y0) * bounds_.width() + x - bounds_.x0)];
  Rgb sum;
  for (int i = 0; i < rgb_size; ++i) sum.c[i] = float(pixel.sums[i].take().value());
  if (pixel.broken.exchange(false, std::memory_order_relaxed)) sum = gray_rgb(std::numeric_limits<float>::quiet_NaN());
  return sum;
}

}  // namespace montelux
