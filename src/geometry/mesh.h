// A triangle mesh (and, beside the triangles, bilinear quadrilaterals) as plain arrays.
#pragma once
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace montelux {

// Where the vertices of a mesh are, and its normals (as many as the mesh has), at one moment.
struct MeshPose {
  std::vector<Vec3f> positions, normals;
};

// Vertex attributes are per vertex or absent (empty). Indices are in range and 3 (4) a face; the readers see to it.
struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;   // unit not required; empty: flat shading
  std::vector<Vec3f> tangents;  // empty: from uv
  std::vector<Vec2f> uvs;       // empty: the barycentric default (0,0), (1,0), (1,1)
  std::vector<std::uint32_t> triangles;
  // A mesh that changes its form: at the moments after the first, evenly spaced up to the end of the transforms' time;
  // vertices go straight from one to the next.
  std::vector<MeshPose> later;
  std::vector<std::uint32_t> quads;  // four a face, in the order of a bilinear patch: p00, p10, p01, p11
};

}  // namespace montelux
