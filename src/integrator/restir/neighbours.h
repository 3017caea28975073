// The pixels whose samples another pixel reuses.
#pragma once
#include <cmath>
#include <optional>

#include "integrator/restir/pixels.h"
#include "integrator/restir/settings.h"
#include "integrator/restir/vertex.h"

namespace montelux {

// As their pixels see them.
inline bool are_similar(const ReuseVertex<float>& a, const ReuseVertex<float>& b) {
  const float side = (a.wo.z < 0) == (b.wo.z < 0) ? 1.0f : -1.0f;
  return are_normals_similar(side * dot(a.frame.n, b.frame.n)) && are_depths_similar(a.depth, b.depth);
}

// A pixel drawn uniformly from a disk around (x, y), by `u`. The choice looks at surfaces alone, never at what was
// found there: the shares of a combination would not add up to one otherwise.
inline std::optional<std::size_t> neighbour(const RestirSettings& settings, const PixelBounds& picture,
                                            std::span<const ReuseVertex<float>> vertices, int x, int y, Vec2f u) {
  const float r = settings.radius * std::sqrt(u.x), angle = 2 * pi * u.y;
  const int dx = int(std::lround(r * std::cos(angle))), dy = int(std::lround(r * std::sin(angle)));
  const int at_x = x + dx, at_y = y + dy;
  if ((dx == 0 && dy == 0) || at_x < picture.x0 || at_x >= picture.x1 || at_y < picture.y0 || at_y >= picture.y1)
    return {};
  const std::size_t pixel = pixel_number(picture, at_x, at_y);
  if (vertices[pixel].exists == 0) return {};
  if (settings.similar && !are_similar(vertices[pixel_number(picture, x, y)], vertices[pixel])) return {};
  return pixel;
}

}  // namespace montelux
