#include "geometry/tessellate.h"

#include <algorithm>

#include "geometry/double3.h"

namespace montelux {

namespace {

bool is_finite_point(Vec3f p) { return is_finite(p.x) && is_finite(p.y) && is_finite(p.z); }

// a00 + a11 = a10 + a01, up to a millionth of the spread.
bool is_affine(const std::array<Vec3d, 4>& a) {
  double spread = 0;
  for (int k = 1; k < 4; ++k) spread = std::max(spread, norm(a[k] - a[0]));
  return norm(a[0] + a[3] - a[1] - a[2]) <= 1e-6 * spread;
}

void append_vertex(Mesh& to, const Mesh& from, std::uint32_t i, Vec2f uv) {
  to.positions.push_back(from.positions[i]);
  if (!from.normals.empty()) to.normals.push_back(from.normals[i]);
  if (!from.tangents.empty()) to.tangents.push_back(from.tangents[i]);
  to.uvs.push_back(uv);
}

}  // namespace

bool is_parallelogram(const std::array<Vec3f, 4>& p) {
  return is_affine({to_double(p[0]), to_double(p[1]), to_double(p[2]), to_double(p[3])});
}

namespace {

// Corners p00, p10, p01, p11 (and normals likewise) of one quadrilateral.
struct QuadCorners {
  std::array<Vec3d, 4> p, n{}, uv;
};

// Whether the corners lie in a plane, to a millionth of their extent, and no inner angle is above 180 degrees.
bool is_flat_and_convex(const std::array<Vec3d, 4>& p) {
  const std::array<Vec3d, 4> loop{p[0], p[1], p[3], p[2]};
  const Vec3d n = cross(p[3] - p[0], p[2] - p[1]);
  const double size = std::sqrt(dot(n, n));
  if (!(size > 0)) return false;
  if (std::abs(dot(p[1] - p[0], n)) > 1e-6 * size * std::sqrt(size)) return false;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3d a = loop[(k + 1) % 4] - loop[k], b = loop[(k + 2) % 4] - loop[(k + 1) % 4];
    if (!(dot(cross(a, b), n) > 0)) return false;
  }
  return true;
}

// Separates the quadrilaterals by a rule that decides which of them become triangles.
template <class Rule>
SplitMesh split_quads(const Mesh& mesh, Rule becomes_triangles) {
  SplitMesh r;
  r.triangles = mesh;
  r.triangles.quads.clear();
  const bool has_uv = !mesh.uvs.empty();
  auto uv_of = [&](std::uint32_t i, std::size_t k) {
    return has_uv ? mesh.uvs[i] : Vec2f{float(k & 1), float(k >> 1)};
  };
  // Without texture coordinates the triangles' defaults differ from the quadrilateral's: then each face has its own
  // vertices, with explicit coordinates.
  const bool has_triangles = !mesh.triangles.empty();
  if (!has_uv && !mesh.quads.empty()) {
    Mesh explicit_mesh;
    for (std::size_t k = 0; has_triangles && k < mesh.triangles.size(); ++k) {
      append_vertex(explicit_mesh, mesh, mesh.triangles[k], k % 3 == 0 ? Vec2f{0, 0} : Vec2f{1, float(k % 3 == 2)});
      explicit_mesh.triangles.push_back(std::uint32_t(k));
    }
    r.triangles = std::move(explicit_mesh);
  }
  for (std::size_t q = 0; q + 3 < mesh.quads.size(); q += 4) {
    std::array<std::uint32_t, 4> i{};
    QuadCorners corners;
    auto& [p, n, uv] = corners;
    for (std::size_t k = 0; k < 4; ++k) {
      i[k] = mesh.quads[q + k];
      p[k] = to_double(mesh.positions[i[k]]);
      if (!mesh.normals.empty()) n[k] = to_double(mesh.normals[i[k]]);
      Vec2f t = uv_of(i[k], k);
      uv[k] = {t.x, t.y, 0};
    }
    const bool affine = becomes_triangles(corners);
    Mesh& target = affine ? r.triangles : r.patches;
    std::array<std::uint32_t, 4> v = i;
    if (!affine || !has_uv)
      for (std::size_t k = 0; k < 4; ++k) {
        v[k] = std::uint32_t(target.positions.size());
        append_vertex(target, mesh, i[k], uv_of(i[k], k));
      }
    if (affine)
      target.triangles.insert(target.triangles.end(), {v[0], v[1], v[3], v[0], v[3], v[2]});
    else
      target.quads.insert(target.quads.end(), v.begin(), v.end());
  }
  return r;
}

}  // namespace

SplitMesh split_affine_quads(const Mesh& mesh) {
  return split_quads(mesh, [](const QuadCorners& c) { return is_affine(c.p) && is_affine(c.n) && is_affine(c.uv); });
}

SplitMesh split_flat_quads(const Mesh& mesh) {
  return split_quads(mesh, [](const QuadCorners& c) { return is_flat_and_convex(c.p) && is_affine(c.n); });
}

RepairedMesh drop_degenerate_triangles(const Mesh& mesh) {
  RepairedMesh r{mesh, 0};
  r.mesh.triangles.clear();
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    Vec3f a = mesh.positions[mesh.triangles[t]], b = mesh.positions[mesh.triangles[t + 1]],
          c = mesh.positions[mesh.triangles[t + 2]];
    Vec3d n = cross(to_double(b) - to_double(a), to_double(c) - to_double(a));
    if (is_finite_point(a) && is_finite_point(b) && is_finite_point(c) && norm(n) > 0)
      r.mesh.triangles.insert(r.mesh.triangles.end(), mesh.triangles.begin() + std::ptrdiff_t(t),
                              mesh.triangles.begin() + std::ptrdiff_t(t) + 3);
    else
      ++r.dropped;
  }
  return r;
}

WorldMesh to_world(const Mesh& mesh, const Transform& object_to_world, bool reverse_orientation) {
  WorldMesh r{mesh, reverse_orientation != object_to_world.swaps_handedness()};
  const Matrix4 &m = object_to_world.matrix(), &inverse = object_to_world.inverse_matrix();
  auto place = [&](std::vector<Vec3f>& positions, std::vector<Vec3f>& normals) {
    for (Vec3f& p : positions) p = to_float(transform_point(m, to_double(p)));
    for (Vec3f& n : normals)
      n = to_float(unit(transform_normal(inverse, to_double(n))) * (reverse_orientation ? -1.0 : 1.0));
  };
  place(r.mesh.positions, r.mesh.normals);
  for (MeshPose& pose : r.mesh.later) place(pose.positions, pose.normals);
  for (Vec3f& t : r.mesh.tangents) t = to_float(transform_direction(m, to_double(t)));
  return r;
}

}  // namespace montelux
