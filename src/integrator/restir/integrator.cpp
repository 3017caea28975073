#include "integrator/restir/integrator.h"

#include "integrator/restir/series.h"

namespace montelux {

RestirIntegrator::RestirIntegrator(const Scene& scene, const Accel& accel, const RestirSettings& settings)
    : scene_(scene),
      accel_(accel),
      settings_(settings),
      lights_(std::make_unique<LightTechniques>(scene, accel, settings)) {
  PathSettings& path = settings_.path;
  if (path.mis == PathMis::automatic && !lights_->are_compensated) path.mis = PathMis::power;
  if (path.lamp_rays > 0) path.lamp_pixels = LampPixels::of(scene, accel, path.width, path.height);
}
RestirIntegrator::~RestirIntegrator() = default;

int RestirIntegrator::stages() const { return ReuseSeries<float, Accel>::stages(settings_); }

std::unique_ptr<FrameSeries> RestirIntegrator::begin(const SeriesPass& pass) const {
  const RestirScene<Accel> shared{scene_, *lights_, accel_, settings_};
  if (settings_.path.lanes == Lanes::one) return std::make_unique<ReuseSeries<float, Accel>>(shared, pass);
  return std::make_unique<ReuseSeries<NativeFloats, Accel>>(shared, pass);
}

}  // namespace montelux
