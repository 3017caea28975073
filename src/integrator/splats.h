// A picture to which light is added anywhere, by any thread, in any order: the sum is the same bits.
#pragma once
#include <cmath>
#include <limits>
#include <vector>

#include "color/rgb.h"
#include "filter/filter.h"
#include "image/pixel_sample.h"
#include "integrator/tally.h"
#include "math/exact_sum.h"
#include "math/square_locks.h"

namespace montelux {

// Pixel j shows the integral of filter(r - centre of j) L(r) over places r of the picture. A camera path draws r by the
// filter; a splat at r arrives where light leads it, so that every pixel within the filter's reach takes its share,
// filter(r - centre) (Veach 1997, sec. 10.3.4.3): deterministic, signed where the filter is.
class SplatPlane {
 public:
  SplatPlane(const PixelBounds& bounds, const Filter& filter) : SplatPlane(PixelGrid{bounds}, filter) {}
  // Holds only the pixels that represent cells of the grid, or the means of all pixels of each. `layers`: the plan of
  // the layers that it keeps as well, which must outlive it.
  SplatPlane(const PixelGrid& grid, const Filter& filter, const LayerPlan* layers = nullptr)
      : grid_(grid),
        cells_(grid.cells()),
        filter_(filter),
        layers_(layers),
        pixels_(std::size_t(cells_.area())),
        layer_sums_(layers ? pixels_.size() * std::size_t(layers->count()) * rgb_size : 0),
        locks_(cells_.width(), cells_.height()) {}
  const PixelGrid& grid() const { return grid_; }
  const LayerPlan* layers() const { return layers_; }

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
  // The same where it comes from there: also to its layers. Requires layers().
  void add(Vec2f raster, const Rgb& value, const LightOrigin<float>& from);
  // Adds to the pixel of one cell alone: light that was drawn by the filter of this pixel.
  void add_to_pixel(int x, int y, const Rgb& value);
  // The same where it comes from there: also to its layers. Requires layers().
  void add_to_pixel(int x, int y, const Rgb& value, const LightOrigin<float>& from);
  // What was added to a pixel, stated by its cell, since the last time. Only while nobody adds.
  Rgb take(int x, int y);
  // The same of each pixel of a tile, in row-major order, added to its sample and, if there are layers, to its sums, as
  // PixelIntegrator::trace_layers() has them. A sample that is not a number then has no sums.
  void take_tile(const PixelBounds& tile, std::span<PixelSample> samples, std::span<ExactRgb> sums);

 private:
  struct Pixel {
    ExactSum sums[rgb_size];
    bool broken = false;
  };
  std::size_t pixel_number(int x, int y) const {
    return std::size_t(y - cells_.y0) * std::size_t(cells_.width()) + std::size_t(x - cells_.x0);
  }
  Pixel& pixel(int x, int y) { return pixels_[pixel_number(x, y)]; }
  // The sums of a layer, by channel.
  ExactSum* layer_sums(int x, int y, std::size_t layer) {
    return &layer_sums_[(pixel_number(x, y) * std::size_t(layers_->count()) + layer) * rgb_size];
  }
  // Calls visit(x, y, weight) for the cell of each pixel that a splat at this place reaches, with the filter's weight,
  // which counts in part where cells show means. The cells are locked.
  template <class Visit>
  void for_each_pixel_near(Vec2f raster, Visit visit);
  // What is added to a pixel, whose cell is locked. Whether the pixel can hold it.
  static bool add_to(Pixel& pixel, const Rgb& value, float weight);
  void add_to_layers(int x, int y, const Rgb& value, float weight, const LightOrigin<float>& from);
  void take_into(int x, int y, PixelSample& sample, std::span<ExactRgb> sums);
  // Calls change() with the cells x0 to x1 and y0 to y1 locked.
  template <class Change>
  void lock_and(int x0, int y0, int x1, int y1, Change change) {
    locks_.lock_and(x0 - cells_.x0, y0 - cells_.y0, x1 - cells_.x0, y1 - cells_.y0, change);
  }
  // The pixels that a splat at this place reaches; with an area of 0 if there are none.
  PixelBounds pixels_near(Vec2f raster) const;
  // The cells that these pixels represent.
  PixelBounds represented_cells(const PixelBounds& near) const;

  PixelGrid grid_;
  PixelBounds cells_;
  const Filter& filter_;
  const LayerPlan* layers_;
  std::vector<Pixel> pixels_;
  std::vector<ExactSum> layer_sums_;  // by pixel and layer
  SquareLocks locks_;                 // of the cells, for what is added
};

}  // namespace montelux
