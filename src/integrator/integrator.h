// What the scheduler asks of an integrator. Integrators know no threads, no film and no files.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <stdexcept>

#include "camera/shutter.h"
#include "image/layers.h"
#include "image/pixel_sample.h"
#include "mc/point_set.h"

namespace montelux {

// One pass over one tile: every pixel of the tile takes points.samples_per_pass samples.
struct TilePass {
  PixelBounds tile;
  PointSet points;
  std::optional<Shutter> shutter{};  // instead of the scene's
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

  // Whether trace_layers() is there.
  virtual bool has_layers() const { return false; }
  // The same, and adds what the samples bring to sums: at each pixel of the tile plan.count() + 1 of them behind each
  // other, all light and then the layers. Samples that are not finite are not in the sums.
  virtual RayCounts trace_layers(const TilePass&, const LayerPlan&, std::span<PixelSample>, std::span<ExactRgb>) const {
    throw std::logic_error("this integrator has no layers");
  }
};

}  // namespace montelux
