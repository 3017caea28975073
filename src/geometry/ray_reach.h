// The limits of distance and size for the ray-tracing kernel, which works in single precision.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/transform.h"

namespace montelux {

// Coordinates of origins and directions of rays up to this are valid, in the world and in the spaces of instances.
inline constexpr float max_ray_coordinate = 1e18f;

// The limit up to which world rays are also valid in the space of an object with this transform; below 0 if none is.
inline float ray_reach(const Transform& object_to_world) {
  const std::array<float, 12>& rows = object_to_world.inverse_rows();
  float reach = max_ray_coordinate;
  for (std::size_t r = 0; r < 3; ++r) {
    const float scale = std::abs(rows[4 * r]) + std::abs(rows[4 * r + 1]) + std::abs(rows[4 * r + 2]);
    const float own = (max_ray_coordinate - std::abs(rows[4 * r + 3])) / std::max(scale, 1.0f);
    reach = own <= reach ? own : std::isnan(own) ? -1.0f : reach;
  }
  return reach;
}

}  // namespace montelux
