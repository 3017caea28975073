// Lights that paths meet by chance alone: how bright a sample may be that no sample so far has shown.
#pragma once
#include "accel/accel.h"
#include "color/rgb.h"
#include "integrator/path_classes.h"
#include "scene/scene.h"

namespace montelux {

// Which lights are found only where a ray that is not sampled toward them meets them. Lights with holes are always
// among them.
enum class ChanceLights {
  specular,  // those behind perfect mirrors and smooth glass, where the integrator has no other way to find them
  all,
};

// The largest radiance of these lights, by channel, as a pixel shows it; black where paths by this search meet none.
// Delta lights are not among them: no ray meets those. A pure function of the scene.
Rgb max_chance_radiance(ChanceLights lights, LightSearch search, const Scene& scene, const Accel& accel, int width,
                        int height);

}  // namespace montelux
