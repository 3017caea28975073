// A triangle mesh (with bilinear quadrilaterals besides the triangles) as plain arrays.
#pragma once
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace montelux {

// The vertices of a mesh, and its normals (as many as the mesh has), at one time.
struct MeshPose {
  std::vector<Vec3f> positions, normals;
};

// Vertex attributes are per vertex or absent (empty). The readers ensure that indices are in range and 3 (4) per face.
struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;   // unit not required; empty: flat shading
  std::vector<Vec3f> tangents;  // empty: from uv
  std::vector<Vec2f> uvs;       // empty: the barycentric default (0,0), (1,0), (1,1)
  std::vector<std::uint32_t> triangles;
  // For a deforming mesh: the poses at the times after the first, evenly spaced up to the end of the transforms' time;
  // vertices are interpolated linearly between them.
  std::vector<MeshPose> later;
  std::vector<std::uint32_t> quads;  // four per face, in the order of a bilinear patch: p00, p10, p01, p11
};

}  // namespace montelux
