#include "geometry/bilinear.h"

#include <algorithm>

#include "geometry/double_ray.h"
#include "geometry/quadrature.h"

namespace montelux {

namespace {

struct Patch {
  Vec3d p00, p10, p01, p11;
  Vec3d at(double u, double v) const { return mix(v, mix(u, p00, p10), mix(u, p01, p11)); }
  Vec3d du(double v) const { return mix(v, p10 - p00, p11 - p01); }
  Vec3d dv(double u) const { return mix(u, p01 - p00, p11 - p10); }
  // dp/du x dp/dv, whose length is the area element.
  Vec3d normal(double u, double v) const { return cross(du(v), dv(u)); }
};

Patch in_double(const BilinearPatch& s) {
  return {to_double(s.p[0]), to_double(s.p[1]), to_double(s.p[2]), to_double(s.p[3])};
}

// The normal, from a point slightly further inside if the patch degenerates to an edge or a point.
Vec3d unit_normal(const Patch& q, double u, double v) {
  Vec3d n = q.normal(u, v);
  double scale = dot(q.du(v), q.du(v)) + dot(q.dv(u), q.dv(u));
  if (norm(n) <= 1e-12 * scale) n = q.normal(mix(1e-3, u, 0.5), mix(1e-3, v, 0.5));
  return norm(n) > 0 ? unit(n) : Vec3d{0, 0, 1};
}

// Area elements at the corners, none much smaller than the largest, so that the density stays bounded.
std::array<double, 4> corner_weights(const Patch& q) {
  std::array<double, 4> w{norm(q.normal(0, 0)), norm(q.normal(1, 0)), norm(q.normal(0, 1)), norm(q.normal(1, 1))};
  double largest = *std::max_element(w.begin(), w.end());
  if (!(largest > 0)) return {1, 1, 1, 1};
  for (double& x : w) x = std::max(x, 0.01 * largest);
  return w;
}

// Samples x in [0, 1] with density proportional to (1-x) a + x b.
double sample_linear_weight(double u, double a, double b) {
  return std::min(u * (a + b) / (a + std::sqrt(mix(u, a * a, b * b))), 1.0);
}

double parameter_density(const std::array<double, 4>& w, double u, double v) {
  return 4 * mix(v, mix(u, w[0], w[1]), mix(u, w[2], w[3])) / (w[0] + w[1] + w[2] + w[3]);
}

Density<Area> density_at(const Patch& q, double u, double v) {
  double element = norm(q.normal(u, v));
  if (!(element > 0)) return {0.0f};
  return {float(parameter_density(corner_weights(q), u, v) / element)};
}

// dp/ds along the first texture coordinate; along u if the texture coordinates are degenerate.
Vec3d texture_tangent(const BilinearPatch& s, const Patch& q, double u, double v) {
  auto gradient = [&](auto coordinate) {
    std::array<double, 4> c{coordinate(s.uv[0]), coordinate(s.uv[1]), coordinate(s.uv[2]), coordinate(s.uv[3])};
    return Vec2<double>{mix(v, c[1] - c[0], c[3] - c[2]), mix(u, c[2] - c[0], c[3] - c[1])};
  };
  Vec2<double> ds = gradient([](Vec2f a) { return double(a.x); }), dt = gradient([](Vec2f a) { return double(a.y); });
  double determinant = ds.x * dt.y - ds.y * dt.x;
  double scale = (std::abs(ds.x) + std::abs(ds.y)) * (std::abs(dt.x) + std::abs(dt.y));
  Vec3d along = q.du(v);
  if (std::abs(determinant) > 1e-9 * scale) along = (along * dt.y - q.dv(u) * dt.x) * (1 / determinant);
  return along;
}

}  // namespace

BilinearPatch patch_of(const Mesh& mesh, std::size_t quad, bool flip_normal) {
  BilinearPatch s;
  s.flip_normal = flip_normal;
  if (!mesh.normals.empty()) s.normals.emplace();
  for (std::size_t k = 0; k < 4; ++k) {
    std::uint32_t i = mesh.quads[4 * quad + k];
    s.p[k] = mesh.positions[i];
    if (!mesh.uvs.empty()) s.uv[k] = mesh.uvs[i];
    if (s.normals) (*s.normals)[k] = mesh.normals[i];
  }
  return s;
}

Bounds3 bounds(const BilinearPatch& s) {
  Bounds3 b;
  for (const Vec3f& p : s.p) b = join(b, p);
  return padded(to_double(b.low), to_double(b.high));
}

namespace {

// The corners, in every lane.
template <class D>
struct Corners {
  Vec3<D> p00, p10, p01, p11;
  explicit Corners(const Patch& q) : p00(in(q.p00)), p10(in(q.p10)), p01(in(q.p01)), p11(in(q.p11)) {}
  static Vec3<D> in(const Vec3d& p) { return {D(p.x), D(p.y), D(p.z)}; }
};

template <class D>
Vec3<D> mix(D t, const Vec3<D>& a, const Vec3<D>& b) {
  return a * (D(1.0) - t) + b * t;
}

template <class D>
D largest_component(const Vec3<D>& p) {
  const auto magnitude = [](D x) { return copysign(x, D(1.0)); };
  return max(magnitude(p.x), max(magnitude(p.y), magnitude(p.z)));
}

// The hits on the lines of constant u, if their v is on the patch.
template <class D>
DoubleHits<D> hits_on_lines(const Corners<D>& q, const DoubleRay<D>& ray, D u) {
  const D slack = 1e-10;
  MaskOfDouble<D> found = (u >= -slack) & (u <= D(1.0) + slack);
  // Of the two lines of a patch that is nearly flat, one is far outside.
  if (!any(found)) return {found, u, u, u};
  u = min(max(u, D(0.0)), D(1.0));
  const Vec3<D> a = mix(u, q.p00, q.p10) - ray.o, along = mix(u, q.p01 - q.p00, q.p11 - q.p10);
  const Vec3<D> n = cross(ray.d, along);
  const D squared = dot(n, n);
  const Vec3<D> m = cross(n, a);
  const D t = dot(m, along) / squared, v = dot(m, ray.d) / squared;
  found = found & (squared > D(0.0)) & (v >= -slack) & (v <= D(1.0) + slack);
  // Hits closer than the rounding of their own distance belong to a ray that leaves the patch: an origin exactly
  // in the plane of a flat patch requires this, because no offset moves it out of that plane.
  const D magnitude = max(max(largest_component(q.p00), largest_component(q.p10)),
                          max(max(largest_component(q.p01), largest_component(q.p11)), largest_component(ray.o)));
  found = found & ray.contains(t) & (t * sqrt(dot(ray.d, ray.d)) > D(1e-12) * magnitude);
  return {found, t, u, min(max(v, D(0.0)), D(1.0))};
}

// The lines of constant u that a ray meets solve a + b u + c u^2 = 0 (Reshetov 2019).
template <class D>
DoubleHits<D> nearest_hits(const Corners<D>& q, const DoubleRay<D>& ray) {
  const Vec3<D> e00 = q.p01 - q.p00, e11 = q.p11 - q.p10;
  const D a = dot(cross(q.p00 - ray.o, ray.d), e00), c = dot(cross(q.p10 - q.p00, q.p01 - q.p11), ray.d);
  const D b = dot(cross(q.p10 - ray.o, ray.d), e11) - a - c;
  const D discriminant = b * b - D(4.0) * a * c;
  const D h = (-b - copysign(sqrt(max(discriminant, D(0.0))), b)) / D(2.0);
  // A patch that is flat along u has c = 0 up to rounding; then h / c is far outside, and a / h is the hit.
  const DoubleHits<D> first = hits_on_lines(q, ray, select(c != D(0.0), h / c, D(-1.0)));
  const DoubleHits<D> second = hits_on_lines(q, ray, select(h != D(0.0), a / h, D(-1.0)));
  const MaskOfDouble<D> takes_second = second.found & ((!first.found) | (second.t < first.t));
  const MaskOfDouble<D> found = (discriminant >= D(0.0)) & (first.found | second.found);
  return {found, select(takes_second, second.t, first.t), select(takes_second, second.u, first.u),
          select(takes_second, second.v, first.v)};
}

}  // namespace

std::optional<ShapeHit> intersect(const BilinearPatch& s, const Ray<float>& ray, float t_min) {
  const Corners<double> q(in_double(s));
  return hit_after(ray, t_min, [&](const DoubleRay<double>& r) { return nearest_hits(q, r); });
}

void intersect(const BilinearPatch& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits) {
  const Patch patch = in_double(s);
  hits_of(rays, hits, [&]<class D>(const DoubleRay<D>& r) { return nearest_hits(Corners<D>(patch), r); });
}

SurfacePoint<float> surface_point(const BilinearPatch& s, Vec2f uv) {
  Patch q = in_double(s);
  double u = uv.x, v = uv.y;
  Vec3d p = q.at(u, v), n = unit_normal(q, u, v), ns = n;
  if (s.normals) {
    auto corner = [&](std::size_t k) { return to_double((*s.normals)[k]); };
    Vec3d shading = mix(v, mix(u, corner(0), corner(1)), mix(u, corner(2), corner(3)));
    if (norm(shading) > 0) ns = unit(shading);
    if (dot(n, ns) < 0) n = -n;
    if (!(norm(shading) > 0)) ns = n;
  } else if (s.flip_normal) {
    n = -n, ns = n;
  }
  // Rounding to float and, in double, the rounding of the four terms.
  Vec3d largest{0, 0, 0};
  for (Vec3d c : {q.p00, q.p10, q.p01, q.p11})
    largest = {std::max(largest.x, std::abs(c.x)), std::max(largest.y, std::abs(c.y)),
               std::max(largest.z, std::abs(c.z))};
  Vec3d error = abs_of(p) * 0x1p-23 + largest * 0x1p-48;
  auto bilerp = [&](float a, float b, float c, float d) { return float(mix(v, mix(u, a, b), mix(u, c, d))); };
  Vec2f texture{bilerp(s.uv[0].x, s.uv[1].x, s.uv[2].x, s.uv[3].x), bilerp(s.uv[0].y, s.uv[1].y, s.uv[2].y, s.uv[3].y)};
  return {to_float(p), to_float(error), to_float(n), to_float(ns), to_float(texture_tangent(s, q, u, v)), texture};
}

SurfacePoint<float> surface_point(const BilinearPatch& s, const Ray<float>&, const ShapeHit& hit) {
  return surface_point(s, hit.uv);
}

double area(const BilinearPatch& s) {
  Patch q = in_double(s);
  auto element = [&](double u, double v) { return norm(q.normal(u, v)); };
  return integrate_panels(0, 1, 4,
                          [&](double v) { return integrate_panels(0, 1, 4, [&](double u) { return element(u, v); }); });
}

ShapeSample sample_area(const BilinearPatch& s, Vec2f u) {
  Patch q = in_double(s);
  std::array<double, 4> w = corner_weights(q);
  double y = sample_linear_weight(u.y, w[0] + w[1], w[2] + w[3]);
  double x = sample_linear_weight(u.x, mix(y, w[0], w[2]), mix(y, w[1], w[3]));
  Vec2f uv{float(x), float(y)};
  return {surface_point(s, uv), density_at(q, uv.x, uv.y)};
}

Density<Area> area_density(const BilinearPatch& s, Vec2f uv) { return density_at(in_double(s), uv.x, uv.y); }

}  // namespace montelux
