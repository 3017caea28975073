// From what a file states to meshes as the ray tracer wants them.
#pragma once
#include <array>
#include <cstddef>

#include "geometry/mesh.h"
#include "math/transform.h"

namespace montelux {

// Loop's subdivision surface of the control mesh's triangles after `levels` >= 0 refinements, with every vertex moved
// to its limit position and with limit normals (Loop 1987; Hoppe et al. 1994 for the boundary). Boundary curves are
// cubic B-splines. Normals point to the side from which the control triangles are clockwise, as in pbrt. Edges that
// more than two triangles share, or two in opposite senses, count as boundary.
Mesh loop_subdivide(const Mesh& control, int levels = 3);

// Whether corners p00, p10, p01, p11 span a parallelogram, to a millionth of its size: its bilinear patch is flat and
// its parametrisation affine.
bool is_parallelogram(const std::array<Vec3f, 4>& p);

// A mesh whose quadrilaterals are sorted out: affine ones (corners, texture coordinates and normals alike) as
// triangles with the same texture coordinates, the others as they were. `patches` shares no vertex with `triangles`.
struct SplitMesh {
  Mesh triangles;
  Mesh patches;
};
SplitMesh split_affine_quads(const Mesh& mesh);
// The same with all flat, convex ones as triangles: the same surface, but with other parameters over it.
SplitMesh split_flat_quads(const Mesh& mesh);

// The mesh without triangles of no area, of repeated or of non-finite vertices; how many there were.
struct RepairedMesh {
  Mesh mesh;
  std::size_t dropped;
};
RepairedMesh drop_degenerate_triangles(const Mesh& mesh);

// The mesh in world space. Indices keep their order; `flip_normal` says that the geometric normal is against
// (p1 - p0) x (p2 - p0) where there are no vertex normals. Vertex normals are turned round by reverse_orientation.
struct WorldMesh {
  Mesh mesh;
  bool flip_normal;
};
WorldMesh to_world(const Mesh& mesh, const Transform& object_to_world, bool reverse_orientation);

}  // namespace montelux
