// A picture to which light is added anywhere, by any thread, in any order: the sum is the same bits.
#pragma once
#include <cmath>
#include <limits>
#include <vector>

#include "color/rgb.h"
#include "filter/filter.h"
#include "image/pixel_sample.h"
#include "math/shared_exact_sum.h"

namespace montelux {

// Pixel j shows the integral of filter(r - centre of j) L(r) over places r of the picture. A camera path draws r by the
// filter; a splat at r arrives where light leads it, so that every pixel within the filter's reach takes its share,
// filter(r - centre) (Veach 1997, sec. 10.3.4.3): deterministic, signed where the filter is.
class SplatPlane {
 public:
  SplatPlane(const PixelBounds& bounds, const Filter& filter) : SplatPlane(PixelGrid{bounds}, filter) {}
  // Holds only the pixels that represent cells of the grid.
  SplatPlane(const PixelGrid& grid, const Filter& filter)
      : grid_(grid), cells_(grid.cells()), filter_(filter), pixels_(std::size_t(cells_.area())) {}
  const PixelGrid& grid() const { return grid_; }

  // Whether a splat at this place may reach a pixel of the picture.
  template <class F>
  Mask<F> reaches(Vec2<F> raster) const {
    const Vec2f r = filter_.radius();
    const PixelBounds& b = grid_.bounds;
    return (raster.x >= float(b.x0) - r.x) & (raster.x <= float(b.x1) + r.x) & (raster.y >= float(b.y0) - r.y) &
           (raster.y <= float(b.y1) + r.y);
  }
  // Adds value, the integral of the light over the splat, in pixels. A value that is not finite, or too large for the
  // sums, spoils the pixels that it reaches: they are not a number.
  void add(Vec2f raster, const Rgb& value);
  // Adds to the pixel of one cell alone: light that was drawn by the filter of this pixel.
  void add_to_pixel(int x, int y, const Rgb& value) { add_to(pixel(x, y), value, 1.0f); }
  // What was added to a pixel, stated by its cell, since the last time. Only while nobody adds.
  Rgb take(int x, int y);

 private:
  struct Pixel {
    SharedExactSum sums[rgb_size];
    std::atomic<bool> broken{false};
  };
  Pixel& pixel(int x, int y) { return pixels_[std::size_t((y - cells_.y0) * cells_.width() + x - cells_.x0)]; }
  static void add_to(Pixel& pixel, const Rgb& value, float weight);
  // The cells whose pixels a splat at this place reaches; with an area of 0 if there are none.
  PixelBounds cells_near(Vec2f raster) const;

  PixelGrid grid_;
  PixelBounds cells_;
  const Filter& filter_;
  std::vector<Pixel> pixels_;
};

}  // namespace montelux
