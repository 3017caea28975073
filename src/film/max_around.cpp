#include "film/max_around.h"

#include <algorithm>

namespace montelux {

Plane max_around(const Plane& plane, int width, int reach) {
  const int height = width > 0 ? int(plane.size() / std::size_t(width)) : 0;
  const auto at = [width](int x, int y) { return std::size_t(y) * std::size_t(width) + std::size_t(x); };
  // Of rows, then of columns.
  Plane rows(plane.size()), all(plane.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto first = plane.begin() + std::ptrdiff_t(at(std::max(x - reach, 0), y));
      rows[at(x, y)] =
          *std::max_element(first, plane.begin() + std::ptrdiff_t(at(std::min(x + reach, width - 1), y)) + 1);
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float& largest = all[at(x, y)] = rows[at(x, y)];
      for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height - 1); ++v)
        largest = std::max(largest, rows[at(x, v)]);
    }
  return all;
}

}  // namespace montelux
