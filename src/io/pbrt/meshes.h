// Meshes from the arrays of a shape's parameters.
#pragma once
#include <optional>

#include "geometry/mesh.h"
#include "io/reporter.h"
#include "parameter/value.h"

namespace montelux::pbrt {

// The mesh of a trianglemesh, bilinearmesh or loopsubdiv, whose arrays leave the parameters. What does not fit together
// is reported; no value then, or where no face is left.
std::optional<Mesh> take_mesh(Entity& shape, Reporter& report);

}  // namespace montelux::pbrt
