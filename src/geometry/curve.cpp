#include "geometry/curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/double3.h"

namespace montelux {

namespace {

using Cubic = std::array<Vec3d, 4>;

Cubic elevated(Vec3d p0, Vec3d p1, Vec3d p2) {
  return {p0, (p0 + p1 * 2.0) * (1.0 / 3), (p1 * 2.0 + p2) * (1.0 / 3), p2};
}

// The Bezier controls of one segment whose first point is `p[0]`.
Cubic segment_controls(const Vec3f* p, CurveBasis basis, int degree) {
  Vec3d a = to_double(p[0]), b = to_double(p[1]), c = to_double(p[2]);
  if (degree == 2) return basis == CurveBasis::bezier ? elevated(a, b, c) : elevated((a + b) * 0.5, b, (b + c) * 0.5);
  Vec3d d = to_double(p[3]);
  if (basis == CurveBasis::bezier) return {a, b, c, d};
  return {(a + b * 4.0 + c) * (1.0 / 6), (b * 2.0 + c) * (1.0 / 3), (b + c * 2.0) * (1.0 / 3),
          (b + c * 4.0 + d) * (1.0 / 6)};
}

struct CurveJet {
  Vec3d p, dpdu;
};

// De Casteljau's algorithm.
CurveJet evaluate(const Cubic& c, double u) {
  Vec3d a = mix(u, c[0], c[1]), b = mix(u, c[1], c[2]), d = mix(u, c[2], c[3]);
  Vec3d e = mix(u, a, b), f = mix(u, b, d);
  Vec3d dpdu = (f - e) * 3.0;
  if (!(norm(dpdu) > 0)) dpdu = c[3] - c[0];
  if (!(norm(dpdu) > 0)) dpdu = {1, 0, 0};
  return {mix(u, e, f), dpdu};
}

// A unit vector along a x b, or any that is orthogonal to b if both are parallel.
Vec3d across(Vec3d a, Vec3d b) {
  Vec3d c = cross(unit(a), unit(b));
  if (norm(c) < 1e-9) c = cross(std::abs(b.x) > 0.9 * norm(b) ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, b);
  return unit(c);
}

}  // namespace

Result<CurveSet> make_curves(const CurveDesc& desc) {
  const std::size_t degree = std::size_t(desc.degree), n = desc.points.size();
  if (degree != 2 && degree != 3) return Failure{"a curve's degree must be 2 or 3"};
  const bool bezier = desc.basis == CurveBasis::bezier;
  if (n < degree + 1 || (bezier && (n - 1) % degree != 0))
    return Failure{"a curve's points do not make up whole segments of its basis and degree"};
  const std::size_t segments = bezier ? (n - 1) / degree : n - degree;
  const bool ribbon = desc.type == CurveType::ribbon;
  if (ribbon && desc.normals.size() != segments + 1)
    return Failure{"a ribbon needs a normal at each end of every segment"};

  CurveSet r;
  r.type = desc.type;
  for (std::size_t s = 0; s < segments; ++s) {
    Cubic c = segment_controls(&desc.points[bezier ? s * degree : s], desc.basis, desc.degree);
    r.first.push_back(std::uint32_t(r.controls.size()));
    for (int k = 0; k < 4; ++k) {
      double along = (double(s) + k / 3.0) / double(segments);
      Vec3f p = to_float(c[k]);
      r.controls.push_back({p.x, p.y, p.z, float(0.5 * mix(along, desc.width0, desc.width1))});
      if (ribbon)
        r.normals.push_back(to_float(mix(k / 3.0, to_double(desc.normals[s]), to_double(desc.normals[s + 1]))));
    }
  }
  return r;
}

CurveSet to_world(const CurveSet& curves, const Transform& object_to_world, bool reverse_orientation) {
  CurveSet r = curves;
  const Matrix4& m = object_to_world.matrix();
  Vec3d x = transform_direction(m, {1, 0, 0}), y = transform_direction(m, {0, 1, 0}),
        z = transform_direction(m, {0, 0, 1});
  double scale = std::cbrt(std::abs(dot(cross(x, y), z)));
  for (CurveControl& c : r.controls) {
    Vec3f p = to_float(transform_point(m, {c.x, c.y, c.z}));
    c = {p.x, p.y, p.z, float(c.radius * scale)};
  }
  for (Vec3f& n : r.normals) n = to_float(transform_normal(object_to_world.inverse_matrix(), to_double(n)));
  r.flip_normal = curves.flip_normal != (reverse_orientation != object_to_world.swaps_handedness());
  return r;
}

void append(CurveSet& to, const CurveSet& more) {
  const auto offset = std::uint32_t(to.controls.size());
  for (std::uint32_t i : more.first) to.first.push_back(i + offset);
  to.controls.insert(to.controls.end(), more.controls.begin(), more.controls.end());
  to.normals.insert(to.normals.end(), more.normals.begin(), more.normals.end());
}

SurfacePoint<float> curve_point(const CurveSet& curves, std::uint32_t segment, float u, const Ray<float>& ray,
                                float t) {
  const CurveControl* c = &curves.controls[curves.first[segment]];
  Cubic control;
  for (int k = 0; k < 4; ++k) control[k] = {c[k].x, c[k].y, c[k].z};
  CurveJet jet = evaluate(control, u);
  double width = 2 * mix(u, c[0].radius, c[3].radius);
  Vec3d d = to_double(ray.d), p = to_double(ray.o) + d * t;

  // The direction across the band, and its normal on the side of the ray's origin or as stated for the ribbon.
  Vec3d side, n;
  if (curves.type == CurveType::ribbon) {
    const Vec3f* normal = &curves.normals[curves.first[segment]];
    side = across(mix(u, unit(to_double(normal[0])), unit(to_double(normal[3]))), jet.dpdu);
    n = unit(cross(jet.dpdu, side)) * (curves.flip_normal ? -1.0 : 1.0);
  } else {
    side = across(d, jet.dpdu);
    n = unit(cross(side, jet.dpdu));
  }
  double v = width > 0 ? std::clamp(0.5 + dot(p - jet.p, side) / width, 0.0, 1.0) : 0.5;
  if (curves.type == CurveType::cylinder) {
    double angle = std::numbers::pi * (v - 0.5);
    n = unit(n * std::cos(angle) + side * std::sin(angle));
  }
  Vec3f ng = to_float(n);
  float error = float(width);
  return {to_float(p), {error, error, error}, ng, ng, to_float(jet.dpdu), {u, float(v)}};
}

}  // namespace montelux
