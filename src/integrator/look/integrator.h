// Quick pictures of one property of the first surface; none of them is the light that the scene sends.
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/look/settings.h"
#include "scene/scene.h"

namespace montelux {

// ao: the share of the cosine-weighted hemisphere that is open (Zhukov, Iones and Kronin 1998), 1 beyond the scene.
// normal: the shading normal n, facing the camera, as (n + 1) / 2. albedo: light reflected of unit light from
// everywhere. depth: distance from the camera ray's origin. irradiance: of direct light, W / m^2, on the side that
// faces the camera.
class LookIntegrator final : public PixelIntegrator {
 public:
  // Scene and accel must outlive the integrator.
  LookIntegrator(const Scene& scene, const Accel& accel, const LookSettings& settings)
      : scene_(scene), accel_(accel), settings_(settings) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override;

 private:
  const Scene& scene_;
  const Accel& accel_;
  LookSettings settings_;
};

}  // namespace montelux
