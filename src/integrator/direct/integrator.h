// Direct light: emission and one scattering event (Hanrahan, CS348B; Shirley, Wang and Zimmerman 1996).
#pragma once
#include "accel/accel.h"
#include "integrator/direct/settings.h"
#include "integrator/layered.h"
#include "scene/scene.h"

namespace montelux {

class DirectIntegrator final : public LayeredIntegrator<DirectIntegrator> {
 public:
  // Scene and accel must outlive the integrator.
  DirectIntegrator(const Scene& scene, const Accel& accel, const DirectSettings& settings)
      : scene_(scene), accel_(accel), settings_(settings) {}

 private:
  friend LayeredIntegrator<DirectIntegrator>;
  template <class Tally>
  RayCounts trace_with(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const;
  const Scene& scene_;
  const Accel& accel_;
  DirectSettings settings_;
};
extern template class LayeredIntegrator<DirectIntegrator>;

}  // namespace montelux
