// What the scheduler asks of an integrator. Integrators know no threads, no film and no files.
#pragma once
#include <array>
#include <span>

#include "image/pixel_sample.h"
#include "mc/point_set.h"

namespace montelux {

// One pass over one tile: every pixel of the tile takes points.samples_per_pass samples.
struct TilePass {
  PixelBounds tile;
  PointSet points;
};

// Rays that were traced, for statistics.
struct RayCounts {
  std::uint64_t camera = 0, scattered = 0, shadow = 0;
  // Camera rays, rays after one scattering event, after two, ...; the last holds all that are deeper. Only integrators
  // that branch fill it.
  std::array<std::uint64_t, 16> by_depth{};
  RayCounts& operator+=(const RayCounts& other) {
    camera += other.camera, scattered += other.scattered, shadow += other.shadow;
    for (std::size_t i = 0; i < by_depth.size(); ++i) by_depth[i] += other.by_depth[i];
    return *this;
  }
  std::uint64_t all() const { return camera + scattered + shadow; }
};

// Maps (pixel, point of the pass) to radiance. A pure function of the scene, the settings and the pass: it may be
// called from many threads at once.
class PixelIntegrator {
 public:
  virtual ~PixelIntegrator() = default;
  // Fills `out`: pixels of the tile in row-major order, the samples of one pixel behind each other.
  virtual RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const = 0;
};

}  // namespace montelux
