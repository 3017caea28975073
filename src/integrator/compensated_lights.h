// Lights as next-event estimation samples them beside directions that materials draw.
#pragma once
#include <optional>

#include "accel/accel.h"
#include "light/light_set.h"
#include "scene/scene.h"

namespace montelux {

// LightSet::compensated() of these lights of the scene. None: as they are, also where light from infinity comes through
// a medium that has no boundary, so that rays do not find all of it.
std::optional<LightSet> compensated_lights(const LightSet& lights, const Scene& scene, const Accel& accel);

}  // namespace montelux
