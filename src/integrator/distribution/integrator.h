// Distribution ray tracing: at each surface a tree of rays branches (Cook, Porter and Carpenter 1984). Its cost grows
// with the product of the branching factors; the count of rays by depth shows it.
#pragma once
#include "accel/accel.h"
#include "integrator/distribution/settings.h"
#include "integrator/layered.h"
#include "scene/scene.h"

namespace montelux {

class DistributionIntegrator final : public LayeredIntegrator<DistributionIntegrator> {
 public:
  // Scene and accel must outlive the integrator.
  DistributionIntegrator(const Scene& scene, const Accel& accel, DistributionSettings settings)
      : scene_(scene), accel_(accel), settings_(std::move(settings)) {}

 private:
  friend LayeredIntegrator<DistributionIntegrator>;
  template <class Tally>
  RayCounts trace_with(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const;
  const Scene& scene_;
  const Accel& accel_;
  DistributionSettings settings_;
};
extern template class LayeredIntegrator<DistributionIntegrator>;

}  // namespace montelux
