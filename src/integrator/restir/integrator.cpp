#include "integrator/restir/integrator.h"

#include "integrator/restir/chain.h"

namespace montelux {

RestirIntegrator::RestirIntegrator(const Scene& scene, const Accel& accel, const RestirSettings& settings)
    : scene_(scene),
      accel_(accel),
      settings_(settings),
      lights_(std::make_unique<LightTechniques>(scene.lights, settings)) {}
RestirIntegrator::~RestirIntegrator() = default;

int RestirIntegrator::stages() const { return ReuseChain<float, Accel>::stages(settings_); }

std::unique_ptr<Chain> RestirIntegrator::begin(const ChainPass& pass) const {
  const RestirScene<Accel> shared{scene_, *lights_, accel_, settings_};
  if (settings_.path.lanes == Lanes::one) return std::make_unique<ReuseChain<float, Accel>>(shared, pass);
  return std::make_unique<ReuseChain<NativeFloats, Accel>>(shared, pass);
}

}  // namespace montelux
