// Meshes from the arrays of a shape's parameters.
#pragma once
#include <optional>

#include "geometry/mesh.h"
#include "io/reporter.h"
#include "parameter/value.h"

namespace montelux::pbrt {

// The mesh of a trianglemesh, bilinearmesh or loopsubdiv, whose arrays are moved out of the parameters. Inconsistencies
// are reported; no value then, or if no face remains.
std::optional<Mesh> take_mesh(Entity& shape, Reporter& report);

}  // namespace montelux::pbrt
