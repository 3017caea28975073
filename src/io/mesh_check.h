// What every reader of meshes makes sure of.
#pragma once
#include <cstddef>

#include "geometry/mesh.h"
#include "parameter/diagnostic.h"

namespace montelux {

struct DroppedFaces {
  std::size_t triangles = 0, quads = 0;
  std::size_t total() const { return triangles + quads; }
};

// Removes the triangles without area and the quadrilaterals of which both halves have none, in every
// pose of the mesh. Indices must be in range.
DroppedFaces drop_degenerate_faces(Mesh& mesh);

// That so many were, at least one, of the mesh of a file or (empty) of one that is stated in place.
Diagnostic dropped_faces_warning(std::size_t count, const std::string& file, const SourceLocation& where);

}  // namespace montelux
