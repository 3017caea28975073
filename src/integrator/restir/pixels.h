// Pixels of a picture, a tile at a time, in lanes.
#pragma once
#include "image/pixel_sample.h"
#include "math/lanes.h"
#include "transport/numbers.h"

namespace montelux {

// The number of a pixel of `picture`, in row-major order.
inline std::size_t pixel_number(const PixelBounds& picture, int x, int y) {
  return std::size_t(y - picture.y0) * std::size_t(picture.width()) + std::size_t(x - picture.x0);
}

// Calls f(number of the first pixel in the picture, its number in the tile, number of pixels) for each row of the tile.
// The pixels of a row have consecutive numbers in both.
template <class Function>
void for_each_row(const PixelBounds& picture, const PixelBounds& tile, Function f) {
  for (int y = tile.y0; y < tile.y1; ++y)
    f(pixel_number(picture, tile.x0, y), std::size_t(y - tile.y0) * std::size_t(tile.width()),
      std::size_t(tile.width()));
}

// Which pixels the lanes `on` are: `output` in the tile, `pixel` in the picture.
template <class F>
struct LanePixels {
  PixelBounds tile;
  Uint<F> output = Uint<F>(0u), pixel = Uint<F>(0u);
  Mask<F> on = Mask<F>(false);

  int x(int k) const { return tile.x0 + int(lane(output, k)) % tile.width(); }
  int y(int k) const { return tile.y0 + int(lane(output, k)) / tile.width(); }

  // The numbers of the pixels in the frame `frame` of the series, for `purpose`.
  RandomStream<F> stream(const PointSet& points, int frame, std::uint32_t dimension, std::uint32_t purpose) const {
    Uint<F> xs = Uint<F>(0u), ys = Uint<F>(0u);
    for_each_lane(on, [&](int k) { set_lane(xs, k, std::uint32_t(x(k))), set_lane(ys, k, std::uint32_t(y(k))); });
    return numbers_of<F>(points, PathSite<F>{xs, ys, Uint<F>(std::uint32_t(frame))})
        .stream(Uint<F>(dimension))
        .fork(Uint<F>(purpose));
  }
};

// The next pixels of the tile for which wanted(pixel) holds, from number `next` of the tile on, which moves.
template <class F, class Wanted>
LanePixels<F> gather_pixels(const PixelBounds& picture, const PixelBounds& tile, std::uint32_t& next, Wanted wanted) {
  LanePixels<F> at{tile};
  std::uint32_t lanes = 0;
  for (int k = 0; k < lanes_of<F> && next < std::uint32_t(tile.area()); ++next) {
    const std::size_t pixel =
        pixel_number(picture, tile.x0 + int(next) % tile.width(), tile.y0 + int(next) / tile.width());
    if (!wanted(pixel)) continue;
    set_lane(at.output, k, next), set_lane(at.pixel, k, std::uint32_t(pixel));
    lanes |= 1u << k++;
  }
  at.on = mask_of_bits<F>(lanes);
  return at;
}

}  // namespace montelux
