// Distribution ray tracing: at each surface a tree of rays branches (Cook, Porter and Carpenter 1984). Its cost grows
// with the product of the branching factors; the count of rays by depth shows it.
#pragma once
#include "accel/accel.h"
#include "integrator/distribution/settings.h"
#include "integrator/integrator.h"
#include "scene/scene.h"

namespace montelux {

class DistributionIntegrator final : public PixelIntegrator {
 public:
  // Scene and accel must outlive the integrator.
  DistributionIntegrator(const Scene& scene, const Accel& accel, DistributionSettings settings)
      : scene_(scene), accel_(accel), settings_(std::move(settings)) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override;
  bool has_layers() const override { return true; }
  RayCounts trace_layers(const TilePass& pass, const LayerPlan& plan, std::span<PixelSample> out,
                         std::span<ExactRgb> sums) const override;

 private:
  template <class Tally>
  RayCounts trace_with(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const;
  const Scene& scene_;
  const Accel& accel_;
  DistributionSettings settings_;
};

}  // namespace montelux
