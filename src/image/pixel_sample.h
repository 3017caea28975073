// One sample of a pixel, and sets of pixels: types that integrators, film and scheduler share.
#pragma once
#include <algorithm>

#include "color/rgb.h"
#include "image/features.h"

namespace montelux {

// Pixels x0 <= x < x1, y0 <= y < y1 of the full image; row 0 is the top.
struct PixelBounds {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  int area() const { return width() * height(); }
  bool operator==(const PixelBounds&) const = default;
};

// The pixels of an image that are sampled: one in each cell of stride x stride pixels. With a stride of 1 cells are
// pixels and have the pixels' coordinates; otherwise cells are counted from 0.
struct PixelGrid {
  PixelBounds bounds;
  int stride = 1;
  // Cells show the mean of their pixels, as those of a coarser image do: each sample is of a pixel that is drawn in the
  // cell. Else they show what one pixel shows.
  bool is_mean = false;

  PixelBounds cells() const {
    if (stride == 1) return bounds;
    return {0, 0, (bounds.width() + stride - 1) / stride, (bounds.height() + stride - 1) / stride};
  }
  // The pixel that represents a cell: the middle one, or the last one if the image ends within the cell.
  int pixel_x(int cell) const { return stride == 1 ? cell : middle(bounds.x0, bounds.x1, cell); }
  int pixel_y(int cell) const { return stride == 1 ? cell : middle(bounds.y0, bounds.y1, cell); }
  // The pixels of a cell.
  PixelBounds pixels(int cell_x, int cell_y) const {
    if (stride == 1) return {cell_x, cell_y, cell_x + 1, cell_y + 1};
    const int x = bounds.x0 + cell_x * stride, y = bounds.y0 + cell_y * stride;
    return {x, y, std::min(x + stride, bounds.x1), std::min(y + stride, bounds.y1)};
  }
  // The cell of a pixel.
  int cell_x(int x) const { return stride == 1 ? x : (x - bounds.x0) / stride; }
  int cell_y(int y) const { return stride == 1 ? y : (y - bounds.y0) / stride; }
  bool operator==(const PixelGrid&) const = default;

 private:
  int middle(int first, int end, int cell) const {
    const int pixel = first + cell * stride + stride / 2;
    return pixel < end ? pixel : end - 1;
  }
};

// One sample of a pixel: what an integrator returns.
struct PixelSample {
  Rgb radiance{};
  Features features;
  // Where pixels share samples and lamps in view have rays of their own, the light of emitters that the camera sees
  // directly is no part of the radiance. For pixels without such rays it is that on the sample's own ray; for its
  // pixel, if that has them (Features::emission_rays is above 1), it is that on these rays.
  Rgb emission{}, lamps{};
  // All light of the sample, as it counts in its own pixel.
  Rgb light() const {
    Rgb all = radiance;
    const Rgb& seen = features.emission_rays > 1 ? lamps : emission;
    for (int c = 0; c < rgb_size; ++c) all.c[c] += seen.c[c];
    return all;
  }
};

}  // namespace montelux
