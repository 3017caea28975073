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

 private:
  const Scene& scene_;
  const Accel& accel_;
  DistributionSettings settings_;
};

}  // namespace montelux
