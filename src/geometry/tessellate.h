// From what a file states to the meshes that the ray tracer needs.
#pragma once
#include <array>
#include <cstddef>

#include "geometry/mesh.h"
#include "math/transform.h"

namespace montelux {

// Loop's subdivision surface of the control mesh's triangles after `levels` >= 0 refinements, with every vertex moved
// to its limit position and with limit normals (Loop 1987; Hoppe et al. 1994 for the boundary). Boundary curves are
// cubic B-splines. Normals point to the side from which the control triangles are clockwise, as in pbrt. Edges
// shared by more than two triangles, or by two in opposite orientation, count as boundary.
Mesh loop_subdivide(const Mesh& control, int levels = 3);

// Whether corners p00, p10, p01, p11 span a parallelogram, to a millionth of its size: then its bilinear patch is flat
// and its parametrisation affine.
bool is_parallelogram(const std::array<Vec3f, 4>& p);

// A mesh whose quadrilaterals are separated: affine ones (in corners, texture coordinates and normals) become
// triangles with the same texture coordinates, the others stay. `patches` shares no vertex with `triangles`.
struct SplitMesh {
  Mesh triangles;
  Mesh patches;
};
SplitMesh split_affine_quads(const Mesh& mesh);
// The same with all flat, convex ones as triangles: the same surface, but with other parameters on it.
SplitMesh split_flat_quads(const Mesh& mesh);

// The mesh without triangles of zero area, or with repeated or non-finite vertices; and their number.
struct RepairedMesh {
  Mesh mesh;
  std::size_t dropped;
};
RepairedMesh drop_degenerate_triangles(const Mesh& mesh);

// The mesh in world space. Indices keep their order; `flip_normal`: the geometric normal is opposite to
// (p1 - p0) x (p2 - p0) if there are no vertex normals. Vertex normals are reversed by reverse_orientation.
struct WorldMesh {
  Mesh mesh;
  bool flip_normal;
};
WorldMesh to_world(const Mesh& mesh, const Transform& object_to_world, bool reverse_orientation);

}  // namespace montelux
