// From a scene as a reader or a program describes it to one that is ready to render. Inside the facade only.
#pragma once
#include "api/scene.h"
#include "io/read_result.h"

namespace montelux {

// Prepares the scene, if it was read without an error. `read_seconds`: how long that took. Never throws.
LoadResult load_description(ReadResult read, const LoadOptions& options, double read_seconds);

}  // namespace montelux
