// Parameters that were stated but never used.
#pragma once
#include "scene/description.h"

namespace montelux {

// Warns, at its position, about each parameter of the scene that preparing it did not look up.
void report_unused(const SceneDesc& scene, Diagnostics& diagnostics);

}  // namespace montelux
