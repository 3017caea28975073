// The difference of two estimated images in regions of equal size, and its expected variance.
#pragma once
#include <array>
#include <vector>

#include "image/pixel_buffer.h"

namespace montelux {

struct EstimatedImage;

// One channel of both images, divided into squares of `side` pixels from the upper left corner, row by row. All values
// are sums over the pixels of a region.
struct RegionGrid {
  int width = 0, height = 0;  // in regions
  int side = 1;
  std::vector<double> difference;               // first image minus second
  std::array<std::vector<double>, 2> variance;  // of each image's sum, where its pixels are independent
  std::array<std::vector<double>, 2> spread;    // of squared variances over degrees of freedom (Satterthwaite 1946)
  std::vector<double> count;                    // pixels

  std::size_t size() const { return difference.size(); }
};

// The channels are indices into the first and the second image.
RegionGrid pixel_grid(const EstimatedImage& a, const EstimatedImage& b, std::array<int, 2> channels);
// Regions of factor x factor regions.
RegionGrid coarser(const RegionGrid& grid, int factor);

// Variances for a test of every region. A mean of few skewed values is too low together with its estimated variance if
// the rare large values are missing. Each image's variance is therefore raised to what is known from elsewhere: to the
// other image's variance at the same place, scaled by the ratio of the two totals, and to the mean of the regions
// within `radius`. Values that are not finite are excluded.
std::array<std::vector<double>, 2> raised_variance(const RegionGrid& grid, int radius);

}  // namespace montelux
