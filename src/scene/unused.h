// Parameters that were stated and that nothing has used.
#pragma once
#include "scene/description.h"

namespace montelux {

// Warns, at its place, of each parameter of the scene that preparing it did not look up: none is ignored in silence.
void report_unused(const SceneDesc& scene, Diagnostics& diagnostics);

}  // namespace montelux
