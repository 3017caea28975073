// Checks that every reader of meshes performs.
#pragma once
#include <cstddef>

#include "geometry/mesh.h"
#include "parameter/diagnostic.h"

namespace montelux {

struct DroppedFaces {
  std::size_t triangles = 0, quads = 0;
  std::size_t total() const { return triangles + quads; }
};

// Removes the triangles without area and the quadrilaterals whose halves both have none, in every
// pose of the mesh. Indices must be in range.
DroppedFaces drop_degenerate_faces(Mesh& mesh);

// Reports that number of faces, at least one, for the mesh of a file or (if empty) one that is stated in place.
Diagnostic dropped_faces_warning(std::size_t count, const std::string& file, const SourceLocation& where);

}  // namespace montelux
