#include "integrator/chance_light.h"

#include <algorithm>
#include <limits>

#include "integrator/missing_light.h"
#include "integrator/smooth_walks.h"

namespace montelux {

namespace {

bool meets_all(ChanceLights lights, LightSearch search, const Scene& scene, const Accel& accel, int width, int height) {
  if (lights == ChanceLights::all) return true;
  if (SmoothTargets(scene).empty()) return false;
  if (finding(search, PathClass::lsde) == Finding::by_chance) return true;
  // Light that an integrator connects is met by chance where both the lamp and the eye are behind smooth surfaces.
  return finding(search, PathClass::lsdse) == Finding::by_chance &&
         !smooth_surfaces_in_view(scene, accel, width, height).empty();
}

}  // namespace

Rgb max_chance_radiance(ChanceLights lights, LightSearch search, const Scene& scene, const Accel& accel, int width,
                        int height) {
  const bool all = meets_all(lights, search, scene, accel, width, height);
  if (!all && !scene.lights.has_masked()) return gray_rgb(0);
  Rgb largest = scene.lights.max_hit_radiance(!all);
  for (float& channel : largest.c) channel = std::min(channel * scene.imaging_ratio, std::numeric_limits<float>::max());
  return largest;
}

}  // namespace montelux
