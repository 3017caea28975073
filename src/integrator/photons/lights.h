// The light paths of photon maps: where they start, and what they leave.
#pragma once
#include <algorithm>
#include <optional>

#include "integrator/light_paths/light_media.h"
#include "integrator/photons/settings.h"

namespace montelux {

struct PhotonLights {
  std::optional<AliasTable> by_power;  // none: there is no light
  std::optional<LightMedia> media;     // none: there are no media, or no lights
};
inline PhotonLights photon_lights(const Scene& scene, const Accel& accel) {
  PhotonLights lights{{}, light_media(scene, accel)};
  if (scene.lights.count() > 0) lights.by_power = scene.lights.by_power();
  return lights;
}

// The light paths of one map.
struct PhotonPaths {
  std::uint32_t count;
  std::uint32_t first_event;     // photons that fewer events have scattered are not stored
  std::optional<int> max_depth;  // scattering events between the light and the camera
  int roulette_depth;
  // Paths end at events in directions which paths from the eye would not follow backwards, those whose density is below
  // this: their photons are those of caustics. None: all paths continue.
  std::optional<float> caustics{};
};

// As many light paths as a setting states; 0: one for each pixel, and at least min_photons.
inline std::uint32_t light_paths(int setting, int pixels) {
  return std::uint32_t(setting > 0 ? setting : std::max(pixels, min_photons));
}

}  // namespace montelux
