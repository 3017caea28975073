// Spatiotemporal resampling by reservoirs, of direct light (Bitterli et al. 2020) and of paths (Ouyang et al. 2021, Lin
// et al. 2022), as an offline estimator: series of frames are independent, so their spread is a valid error bar.
// docs/reuse.md has the method.
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/restir/settings.h"
#include "scene/scene.h"

namespace montelux {

struct LightTechniques;

class RestirIntegrator final : public CoupledIntegrator {
 public:
  // Scene and accel must outlive the integrator, and the integrator its series.
  RestirIntegrator(const Scene& scene, const Accel& accel, const RestirSettings& settings);
  ~RestirIntegrator() override;
  int frames() const override { return settings_.frames; }
  int warm_up() const override { return settings_.warm_up; }
  int stages() const override;
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override;

 private:
  const Scene& scene_;
  const Accel& accel_;
  RestirSettings settings_;
  std::unique_ptr<const LightTechniques> lights_;
};

}  // namespace montelux
