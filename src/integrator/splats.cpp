#include "integrator/splats.h"

#include <algorithm>

namespace montelux {

PixelBounds SplatPlane::cells_near(Vec2f raster) const {
  const Vec2f radius = filter_.radius();
  const PixelBounds& b = grid_.bounds;
  const auto first = [](float at, float reach, int low) { return std::max(int(std::ceil(at - reach - 0.5f)), low); };
  const auto last = [](float at, float reach, int high) {
    return std::min(int(std::floor(at + reach - 0.5f)), high - 1);
  };
  const int x0 = first(raster.x, radius.x, b.x0), x1 = last(raster.x, radius.x, b.x1);
  const int y0 = first(raster.y, radius.y, b.y0), y1 = last(raster.y, radius.y, b.y1);
  if (x0 > x1 || y0 > y1) return {};
  PixelBounds cells{grid_.cell_x(x0), grid_.cell_y(y0), grid_.cell_x(x1) + 1, grid_.cell_y(y1) + 1};
  // The cells at the ends may have their pixels outside.
  if (grid_.pixel_x(cells.x0) < x0) ++cells.x0;
  if (grid_.pixel_y(cells.y0) < y0) ++cells.y0;
  if (grid_.pixel_x(cells.x1 - 1) > x1) --cells.x1;
  if (grid_.pixel_y(cells.y1 - 1) > y1) --cells.y1;
  if (cells.x0 >= cells.x1 || cells.y0 >= cells.y1) return {};
  return cells;
}

void SplatPlane::add_to(Pixel& pixel, const Rgb& value, float weight) {
  float largest = 0;  // of the components, and not a number where one is not
  for (int i = 0; i < rgb_size; ++i) largest += std::abs(value.c[i]);
  if (!(largest * std::abs(weight) < ExactSum::largest)) {
    pixel.broken.store(true, std::memory_order_relaxed);
    return;
  }
  for (int i = 0; i < rgb_size; ++i) pixel.sums[i].add(value.c[i] * weight);
}

void SplatPlane::add(Vec2f raster, const Rgb& value) {
  using F = NativeFloats;
  const PixelBounds cells = cells_near(raster);
  const int across = cells.width(), count = cells.area();
  for (int begin = 0; begin < count; begin += lanes_of<F>) {
    Vec2<F> offset{F(0.0f), F(0.0f)};
    const int n = std::min(count - begin, lanes_of<F>);
    for (int k = 0; k < n; ++k) {
      set_lane(offset.x, k, raster.x - (float(grid_.pixel_x(cells.x0 + (begin + k) % across)) + 0.5f));
      set_lane(offset.y, k, raster.y - (float(grid_.pixel_y(cells.y0 + (begin + k) / across)) + 0.5f));
    }
    const F weight = filter_.evaluate(offset);
    for (int k = 0; k < n; ++k) {
      const float w = lane(weight, k);
      const int x = cells.x0 + (begin + k) % across, y = cells.y0 + (begin + k) / across;
      add_to(pixel(x, y), value, w);
    }
  }
}

Rgb SplatPlane::take(int x, int y) {
  Pixel& from = pixel(x, y);
  Rgb sum;
  for (int i = 0; i < rgb_size; ++i) sum.c[i] = float(from.sums[i].take().value());
  if (from.broken.exchange(false, std::memory_order_relaxed)) sum = gray_rgb(std::numeric_limits<float>::quiet_NaN());
  return sum;
}

}  // namespace montelux
