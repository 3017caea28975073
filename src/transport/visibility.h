// Visibility between two points.
#pragma once
#include <cstdint>

#include "geometry/ray.h"
#include "math/lanes.h"

namespace montelux {

// The lanes of `on` in which no surface blocks the ray. Adds the rays that are traced to `traced`. `rays` has
// occluded() as Accel does.
template <class F, class Rays>
MONTELUX_INLINE Mask<F> unblocked(const Rays& rays, const Ray<F>& ray, Mask<F> on, std::uint64_t& traced) {
  if (!any(on)) return on;
  traced += std::uint64_t(count(on));
  return on & !rays.template occluded<F>(ray, on);
}

}  // namespace montelux
