#include "integrator/splats.h"

#include <algorithm>
#include <utility>

namespace montelux {

PixelBounds SplatPlane::pixels_near(Vec2f raster) const {
  const Vec2f radius = filter_.radius();
  const PixelBounds& b = grid_.bounds;
  const auto first = [](float at, float reach, int low) { return std::max(int(std::ceil(at - reach - 0.5f)), low); };
  const auto last = [](float at, float reach, int high) {
    return std::min(int(std::floor(at + reach - 0.5f)), high - 1);
  };
  const int x0 = first(raster.x, radius.x, b.x0), x1 = last(raster.x, radius.x, b.x1);
  const int y0 = first(raster.y, radius.y, b.y0), y1 = last(raster.y, radius.y, b.y1);
  if (x0 > x1 || y0 > y1) return {};
  return {x0, y0, x1 + 1, y1 + 1};
}

PixelBounds SplatPlane::represented_cells(const PixelBounds& near) const {
  if (near.area() == 0) return {};
  PixelBounds cells{grid_.cell_x(near.x0), grid_.cell_y(near.y0), grid_.cell_x(near.x1 - 1) + 1,
                    grid_.cell_y(near.y1 - 1) + 1};
  // The cells at the ends may have their pixels outside.
  if (grid_.pixel_x(cells.x0) < near.x0) ++cells.x0;
  if (grid_.pixel_y(cells.y0) < near.y0) ++cells.y0;
  if (grid_.pixel_x(cells.x1 - 1) >= near.x1) --cells.x1;
  if (grid_.pixel_y(cells.y1 - 1) >= near.y1) --cells.y1;
  if (cells.x0 >= cells.x1 || cells.y0 >= cells.y1) return {};
  return cells;
}

bool SplatPlane::add_to(Pixel& pixel, const Rgb& value, float weight) {
  float largest = 0;  // of the components, and not a number where one is not
  for (int i = 0; i < rgb_size; ++i) largest += std::abs(value.c[i]);
  if (!(largest * std::abs(weight) < ExactSum::largest)) {
    pixel.broken = true;
    return false;
  }
  for (int i = 0; i < rgb_size; ++i) pixel.sums[i].add(value.c[i] * weight);
  return true;
}

void SplatPlane::add_to_layers(int x, int y, const Rgb& value, float weight, const LightOrigin<float>& from) {
  const OwnLayers own(*layers_, from);
  for (const std::uint32_t layer : own.all())
    for (int i = 0; i < rgb_size; ++i) layer_sums(x, y, layer)[i].add(value.c[i] * weight);
  if (own.alone() < 0) return;
  const Rgb all = without_weight(value, from.weight);
  for (int i = 0; i < rgb_size; ++i) layer_sums(x, y, std::size_t(own.alone()))[i].add(all.c[i] * weight);
}

template <class Visit>
void SplatPlane::for_each_pixel_near(Vec2f raster, Visit visit) {
  using F = NativeFloats;
  const PixelBounds pixels = pixels_near(raster);
  // All pixels, or those that represent cells: by the coordinates of what is visited.
  const PixelBounds all = grid_.is_mean ? pixels : represented_cells(pixels);
  const int across = all.width(), count = all.area();
  if (count == 0) return;
  const auto pixel_x = [&](int x) { return grid_.is_mean ? x : grid_.pixel_x(x); };
  const auto pixel_y = [&](int y) { return grid_.is_mean ? y : grid_.pixel_y(y); };
  const auto cell_x = [&](int x) { return grid_.is_mean ? grid_.cell_x(x) : x; };
  const auto cell_y = [&](int y) { return grid_.is_mean ? grid_.cell_y(y) : y; };
  const auto visit_pack = [&](int begin) {
    Vec2<F> offset{F(0.0f), F(0.0f)};
    const int n = std::min(count - begin, lanes_of<F>);
    for (int k = 0; k < n; ++k) {
      set_lane(offset.x, k, raster.x - (float(pixel_x(all.x0 + (begin + k) % across)) + 0.5f));
      set_lane(offset.y, k, raster.y - (float(pixel_y(all.y0 + (begin + k) / across)) + 0.5f));
    }
    const F weight = filter_.evaluate(offset);
    for (int k = 0; k < n; ++k) {
      const int x = cell_x(all.x0 + (begin + k) % across), y = cell_y(all.y0 + (begin + k) / across);
      visit(x, y, grid_.is_mean ? lane(weight, k) / float(grid_.pixels(x, y).area()) : lane(weight, k));
    }
  };
  lock_and(cell_x(all.x0), cell_y(all.y0), cell_x(all.x1 - 1), cell_y(all.y1 - 1), [&] {
    for (int begin = 0; begin < count; begin += lanes_of<F>) visit_pack(begin);
  });
}

void SplatPlane::add(Vec2f raster, const Rgb& value) {
  for_each_pixel_near(raster, [&](int x, int y, float weight) { add_to(pixel(x, y), value, weight); });
}

void SplatPlane::add(Vec2f raster, const Rgb& value, const LightOrigin<float>& from) {
  for_each_pixel_near(raster, [&](int x, int y, float weight) {
    if (add_to(pixel(x, y), value, weight)) add_to_layers(x, y, value, weight, from);
  });
}

void SplatPlane::add_to_pixel(int x, int y, const Rgb& value) {
  lock_and(x, y, x, y, [&] { add_to(pixel(x, y), value, 1.0f); });
}

void SplatPlane::add_to_pixel(int x, int y, const Rgb& value, const LightOrigin<float>& from) {
  lock_and(x, y, x, y, [&] {
    if (add_to(pixel(x, y), value, 1.0f)) add_to_layers(x, y, value, 1.0f, from);
  });
}

Rgb SplatPlane::take(int x, int y) {
  Pixel& from = pixel(x, y);
  Rgb sum;
  for (int i = 0; i < rgb_size; ++i) sum.c[i] = float(from.sums[i].value());
  if (from.broken) sum = gray_rgb(std::numeric_limits<float>::quiet_NaN());
  from = {};
  return sum;
}

void SplatPlane::take_tile(const PixelBounds& tile, std::span<PixelSample> samples, std::span<ExactRgb> sums) {
  const std::size_t stride = layers_ ? std::size_t(layers_->count()) + 1 : 0;
  std::size_t i = 0;
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x, ++i) take_into(x, y, samples[i], sums.subspan(i * stride, stride));
}

void SplatPlane::take_into(int x, int y, PixelSample& sample, std::span<ExactRgb> sums) {
  if (layers_) {
    const Pixel& from = pixel(x, y);
    for (std::size_t i = 0; i < sums.size(); ++i)
      for (int c = 0; c < rgb_size; ++c)
        sums[i].c[c] += i == 0 ? from.sums[c] : std::exchange(layer_sums(x, y, i - 1)[c], {});
  }
  const Rgb splats = take(x, y);
  bool good = true;
  for (int c = 0; c < rgb_size; ++c) {
    float& light = sample.radiance.c[c];
    light += splats.c[c], good = good && std::abs(light) < ExactSum::largest;
  }
  if (layers_ && !good) {
    sample.radiance = gray_rgb(std::numeric_limits<float>::quiet_NaN());
    std::ranges::fill(sums, ExactRgb{});
  }
}

}  // namespace montelux
