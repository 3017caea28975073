#include "integrator/compensated_lights.h"

#include "integrator/light_paths/light_media.h"

namespace montelux {

std::optional<LightSet> compensated_lights(const LightSet& lights, const Scene& scene, const Accel& accel) {
  if (shines_through_endless_medium(scene, accel)) return std::nullopt;
  return lights.compensated();
}

}  // namespace montelux
