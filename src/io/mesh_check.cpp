#include "io/mesh_check.h"

#include <algorithm>
#include <array>

namespace montelux {

namespace {

using Vec3d = std::array<double, 3>;

Vec3d difference(Vec3f a, Vec3f b) {
  return {double(a.x) - double(b.x), double(a.y) - double(b.y), double(a.z) - double(b.z)};
}
double squared(const Vec3d& a) { return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; }

// Whether the area is zero relative to the edges, within the precision of float coordinates.
bool has_area(Vec3f a, Vec3f b, Vec3f c) {
  Vec3d u = difference(b, a), v = difference(c, a);
  Vec3d n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  constexpr double relative = 1e-10;
  double longest = std::max(squared(u), squared(v));
  return squared(n) > relative * relative * longest * longest;
}

// Keeps the faces of `size` indices that `keep` accepts, in order; returns the number of removed faces.
template <class Keep>
std::size_t keep_faces(std::vector<std::uint32_t>& indices, std::size_t size, Keep keep) {
  std::size_t out = 0;
  for (std::size_t i = 0; i + size <= indices.size(); i += size) {
    if (!keep(&indices[i])) continue;
    if (out != i) std::copy_n(indices.begin() + std::ptrdiff_t(i), size, indices.begin() + std::ptrdiff_t(out));
    out += size;
  }
  std::size_t dropped = (indices.size() - out) / size;
  indices.resize(out);
  return dropped;
}

}  // namespace

DroppedFaces drop_degenerate_faces(Mesh& mesh) {
  const auto triangle_has_area = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::vector<Vec3f>& p = mesh.positions;
    return has_area(p[a], p[b], p[c]) || std::any_of(mesh.later.begin(), mesh.later.end(), [&](const MeshPose& pose) {
             return has_area(pose.positions[a], pose.positions[b], pose.positions[c]);
           });
  };
  DroppedFaces dropped;
  dropped.triangles =
      keep_faces(mesh.triangles, 3, [&](const std::uint32_t* i) { return triangle_has_area(i[0], i[1], i[2]); });
  dropped.quads = keep_faces(mesh.quads, 4, [&](const std::uint32_t* i) {
    return triangle_has_area(i[0], i[1], i[2]) || triangle_has_area(i[1], i[3], i[2]);
  });
  return dropped;
}

Diagnostic dropped_faces_warning(std::size_t count, const std::string& file, const SourceLocation& where) {
  std::string message = std::to_string(count) + (count == 1 ? " face" : " faces");
  if (!file.empty()) message += " of '" + file + "'";
  message += count == 1 ? " has no area and was dropped" : " have no area and were dropped";
  return {Severity::warning,
          where,
          std::move(message),
          {},
          {"{n} meshes have faces without area, {sum} in all, which were dropped", count}};
}

}  // namespace montelux
