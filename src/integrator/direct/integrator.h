// Direct light: emission and one scattering event (Hanrahan, CS348B; Shirley, Wang and Zimmerman 1996).
#pragma once
#include "accel/accel.h"
#include "integrator/direct/settings.h"
#include "integrator/integrator.h"
#include "scene/scene.h"

namespace montelux {

class DirectIntegrator final : public PixelIntegrator {
 public:
  // Scene and accel must outlive the integrator.
  DirectIntegrator(const Scene& scene, const Accel& accel, const DirectSettings& settings)
      : scene_(scene), accel_(accel), settings_(settings) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override;
  bool has_layers() const override { return true; }
  RayCounts trace_layers(const TilePass& pass, const LayerPlan& plan, std::span<PixelSample> out,
                         std::span<ExactRgb> sums) const override;

 private:
  template <class Tally>
  RayCounts trace_with(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const;
  const Scene& scene_;
  const Accel& accel_;
  DirectSettings settings_;
};

}  // namespace montelux
