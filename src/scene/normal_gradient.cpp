#include "scene/normal_gradient.h"

#include "scene/placement.h"

namespace montelux {

namespace {

// A normal (not unit) and its changes nu, nv along the tangents pu, pv.
struct NormalPatch {
  Vec3d n, pu, pv, nu{0, 0, 0}, nv{0, 0, 0};
};

NormalPatch transformed(const NormalPatch& a, const Transform& map) {
  const Matrix4 &m = map.matrix(), &inverse = map.inverse_matrix();
  return {transform_normal(inverse, a.n), transform_direction(m, a.pu), transform_direction(m, a.pv),
          transform_normal(inverse, a.nu), transform_normal(inverse, a.nv)};
}

NormalPatch plane(const Vec3d& pu, const Vec3d& pv) { return {cross(pu, pv), pu, pv}; }

Vec3d any_tangent(const Vec3d& n) {
  const Vec3d a = abs_of(n);
  return unit(cross(n, a.x <= a.y && a.x <= a.z ? Vec3d{1, 0, 0} : a.y <= a.z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}));
}

// In object space, at the point p there.
NormalPatch patch_at(const Sphere&, const Vec3d& p, const Hit<float>&) {
  const Vec3d n = unit(p), s = any_tangent(n), t = cross(n, s);
  return {p, s, t, s, t};
}
NormalPatch patch_at(const Cylinder&, const Vec3d& p, const Hit<float>&) {
  const Vec3d n{p.x, p.y, 0}, around = unit(Vec3d{-p.y, p.x, 0});
  return {n, around, {0, 0, 1}, around, {0, 0, 0}};
}
NormalPatch patch_at(const Disk&, const Vec3d&, const Hit<float>&) { return plane({1, 0, 0}, {0, 1, 0}); }

// Between the four values of a patch: there and its changes along u and v.
struct Bilinear {
  Vec3d value, du, dv;
};
Bilinear between(const std::array<Vec3f, 4>& corners, double u, double v) {
  std::array<Vec3d, 4> c;
  for (std::size_t i = 0; i < 4; ++i) c[i] = to_double(corners[i]);
  return {mix(v, mix(u, c[0], c[1]), mix(u, c[2], c[3])), mix(v, c[1] - c[0], c[3] - c[2]),
          mix(u, c[2] - c[0], c[3] - c[1])};
}
NormalPatch patch_at(const BilinearPatch& s, const Hit<float>& hit) {
  const Bilinear p = between(s.p, double(hit.u), double(hit.v));
  if (s.normals) {
    const Bilinear n = between(*s.normals, double(hit.u), double(hit.v));
    if (dot(n.value, n.value) > 0) return {n.value, p.du, p.dv, n.du, n.dv};
  }
  // n = dp/du x dp/dv; d2p/dudv is constant, the other second derivatives are zero.
  const Vec3d twist = to_double(s.p[0]) - to_double(s.p[1]) - to_double(s.p[2]) + to_double(s.p[3]);
  return {cross(p.du, p.dv), p.du, p.dv, cross(p.du, twist), cross(twist, p.dv)};
}

NormalPatch shape_patch(const Shape& shape, const Hit<float>& hit, const Vec3d& p) {
  return std::visit(
      [&](const auto& s) {
        if constexpr (requires { s.object_to_world; })
          return transformed(patch_at(s, transform_point(s.object_to_world.inverse_matrix(), p), hit),
                             s.object_to_world);
        else
          return patch_at(s, hit);
      },
      shape);
}

NormalPatch triangle_patch(const GeometryStore& store, const GeometryRow& row, const Hit<float>& hit, float time) {
  const auto& corner = store.triangles[row.first + hit.primitive];
  const PoseTime pose = pose_time(row, time);
  // `first`: of the pose at the start; the poses of a mesh are consecutive.
  const auto value = [&](Vec3f MeshVertex::*of, std::uint32_t first) {
    const Vec3d before = to_double(store.vertices[first + pose.before * row.pose_vertices].*of);
    if (row.poses < 2) return before;
    return mix(double(pose.fraction), before, to_double(store.vertices[first + pose.after * row.pose_vertices].*of));
  };
  std::array<Vec3d, 3> p, n;
  for (std::size_t i = 0; i < 3; ++i) p[i] = value(&MeshVertex::position, corner[i]);
  const Vec3d pu = p[1] - p[0], pv = p[2] - p[0];
  if (!(row.flags & GeometryRow::has_normals)) return plane(pu, pv);
  for (std::size_t i = 0; i < 3; ++i) n[i] = value(&MeshVertex::normal, corner[i]);
  const Vec3d nu = n[1] - n[0], nv = n[2] - n[0], here = n[0] + nu * double(hit.u) + nv * double(hit.v);
  if (!(dot(here, here) > 0)) return plane(pu, pv);
  return {here, pu, pv, nu, nv};
}

}  // namespace

NormalGradient::NormalGradient(const Vec3d& n, const Vec3d& pu, const Vec3d& pv, const Vec3d& nu, const Vec3d& nv) {
  const double uu = dot(pu, pu), uv = dot(pu, pv), vv = dot(pv, pv), determinant = uu * vv - uv * uv, size = norm(n);
  if (!(determinant > 0) || !(size > 0)) return;
  n_ = n * (1 / size), nu_ = nu * (1 / size), nv_ = nv * (1 / size);
  au_ = (pu * vv - pv * uv) * (1 / determinant), av_ = (pv * uu - pu * uv) * (1 / determinant);
}

Vec3d NormalGradient::along(const Vec3d& dp) const {
  const Vec3d change = nu_ * dot(au_, dp) + nv_ * dot(av_, dp);
  return change - n_ * dot(n_, change);
}

NormalGradient normal_gradient(const GeometryStore& store, const Hit<float>& hit, const Vec3f& p, const Vec3f& ns,
                               float time) {
  const GeometryRow& row = store.rows[hit.geometry];
  const bool placed = hit.instance != 0;
  const Transform place = placed ? place_at(store, hit.instance - 1, time) : Transform();
  Vec3d at = to_double(p);
  if (placed) at = transform_point(place.inverse_matrix(), at);
  NormalPatch patch = row.kind == GeometryKind::triangles ? triangle_patch(store, row, hit, time)
                                                          : shape_patch(store.shapes[row.first], hit, at);
  if (placed) patch = transformed(patch, place);
  const double side = dot(patch.n, to_double(ns)) < 0 ? -1 : 1;
  return {patch.n * side, patch.pu, patch.pv, patch.nu * side, patch.nv * side};
}

}  // namespace montelux
