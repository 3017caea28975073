#include "denoise/box_mean.h"

#include <algorithm>

namespace montelux {

Plane box_mean(const Plane& plane, int width, int height, int reach) {
  const auto columns = std::size_t(width);
  const auto at = [columns](int x, int y) { return std::size_t(y) * columns + std::size_t(x); };
  // Sums over rows, then over columns, each from its neighbour's.
  std::vector<double> rows(plane.size());
  for (int y = 0; y < height; ++y) {
    double sum = 0;
    for (int x = 0; x < std::min(reach, width); ++x) sum += double(plane[at(x, y)]);
    for (int x = 0; x < width; ++x) {
      if (x + reach < width) sum += double(plane[at(x + reach, y)]);
      if (x - reach - 1 >= 0) sum -= double(plane[at(x - reach - 1, y)]);
      rows[at(x, y)] = sum;
    }
  }
  Plane mean(plane.size());
  std::vector<double> sums(columns);
  const auto add = [&](int y, double sign) {
    for (int x = 0; x < width; ++x) sums[std::size_t(x)] += sign * rows[at(x, y)];
  };
  for (int y = 0; y < std::min(reach, height); ++y) add(y, 1);
  for (int y = 0; y < height; ++y) {
    if (y + reach < height) add(y + reach, 1);
    if (y - reach - 1 >= 0) add(y - reach - 1, -1);
    const int down = std::min(y + reach, height - 1) - std::max(y - reach, 0) + 1;
    for (int x = 0; x < width; ++x) {
      const int across = std::min(x + reach, width - 1) - std::max(x - reach, 0) + 1;
      mean[at(x, y)] = float(sums[std::size_t(x)] / (double(across) * down));
    }
  }
  return mean;
}

}  // namespace montelux
