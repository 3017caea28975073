#include "geometry/quadric.h"

#include <algorithm>

#include "geometry/double3.h"
#include "geometry/quadrature.h"
#include "geometry/quadric_parameters.h"

namespace montelux {

namespace {

// A point of a shape in object space: n unit and outward, dpdu not zero.
struct ObjectPoint {
  Vec3d p, n, dpdu;
};

// The cosine and sine of an azimuth.
struct Around {
  double cos, sin;
};
Around at_azimuth(double phi) { return {std::cos(phi), std::sin(phi)}; }
// Of the point (x, y) at the distance rho from the axis.
Around toward(double x, double y, double rho) { return rho > 0 ? Around{x / rho, y / rho} : Around{1, 0}; }

template <class S>
bool flips(const S& s) {
  return s.reverse_orientation != s.object_to_world.swaps_handedness();
}

template <class S>
Vec3d object_point(const S& s, const Ray<float>& ray, float t) {
  const Matrix4& m = s.object_to_world.inverse_matrix();
  return transform_point(m, to_double(ray.o)) + transform_direction(m, to_double(ray.d)) * double(t);
}

SurfacePoint<float> to_world(const Transform& m, bool flip, const ObjectPoint& q, Vec2f uv) {
  Vec3d p = transform_point(m.matrix(), q.p);
  // Rounding to float and, in double, the rounding of every term of the transform in both directions.
  const auto& rows = m.matrix().m;
  double size = norm(q.p);
  auto error = [&](int i, double x) {
    double terms = std::abs(rows[i][3]) + size * (std::abs(rows[i][0]) + std::abs(rows[i][1]) + std::abs(rows[i][2]));
    return float(std::abs(x) * 0x1p-23 + terms * 0x1p-47);
  };
  Vec3d n = unit(transform_normal(m.inverse_matrix(), q.n)) * (flip ? -1.0 : 1.0);
  Vec3f ng = to_float(n);
  return {to_float(p), {error(0, p.x), error(1, p.y), error(2, p.z)},     ng,
          ng,          to_float(transform_direction(m.matrix(), q.dpdu)), uv};
}

// The ratio of world area to object area on a surface with object normal n.
double area_stretch(const Transform& m, Vec3d n) {
  const auto& a = m.matrix().m;
  Vec3d r0{a[0][0], a[0][1], a[0][2]}, r1{a[1][0], a[1][1], a[1][2]}, r2{a[2][0], a[2][1], a[2][2]};
  double volume = std::abs(dot(r0, cross(r1, r2)));
  return volume * norm(transform_normal(m.inverse_matrix(), n));
}

bool is_similarity(const Transform& m) {
  double a = area_stretch(m, {1, 0, 0}), b = area_stretch(m, {0, 1, 0}), c = area_stretch(m, {0, 0, 1});
  const double s = std::sqrt(0.5);
  double d = area_stretch(m, {s, s, 0}), e = area_stretch(m, {s, 0, s}), f = area_stretch(m, {0, s, s});
  auto [low, high] = std::minmax({a, b, c, d, e, f});
  return high - low <= 1e-9 * high;
}

Density<Area> density_on(const Transform& m, Vec3d n, double object_area) {
  return {float(1 / (object_area * area_stretch(m, n)))};
}

// The rows of the matrix give the extent of a circle of radius r around the z axis from z_low to z_high.
Bounds3 round_bounds(const Transform& m, double r, double z_low, double z_high, bool ball) {
  const auto& a = m.matrix().m;
  auto interval = [&](int i) {
    double across = r * std::hypot(a[i][0], a[i][1]), z0 = a[i][2] * z_low, z1 = a[i][2] * z_high;
    double low = std::min(z0, z1) - across, high = std::max(z0, z1) + across;
    double reach = r * std::hypot(std::hypot(a[i][0], a[i][1]), a[i][2]);
    if (ball) low = std::max(low, -reach), high = std::min(high, reach);
    return std::array<double, 2>{a[i][3] + low, a[i][3] + high};
  };
  auto x = interval(0), y = interval(1), z = interval(2);
  return padded({x[0], y[0], z[0]}, {x[1], y[1], z[1]});
}

// ---- sphere ----

ObjectPoint sphere_at(const Sphere& s, double cos_theta, double sin_theta, Around a) {
  double r = s.radius;
  Vec3d n{sin_theta * a.cos, sin_theta * a.sin, cos_theta};
  double rho = r * std::max(sin_theta, 1e-5) * phi_limit(s.phi_max);
  return {n * r, n, {-rho * a.sin, rho * a.cos, 0}};
}

ObjectPoint sphere_at(const Sphere& s, Vec2f uv) {
  PolarRange range = polar_range(s);
  double theta = mix(uv.y, range.low, range.high);
  return sphere_at(s, std::cos(theta), std::sin(theta), at_azimuth(uv.x * phi_limit(s.phi_max)));
}

double object_area(const Sphere& s) { return phi_limit(s.phi_max) * s.radius * (double(s.z_max) - s.z_min); }

// ---- disk ----

ObjectPoint disk_at(const Disk& s, double r, Around a) {
  double rho = std::max(r, 1e-5 * s.radius) * phi_limit(s.phi_max);
  return {{r * a.cos, r * a.sin, s.height}, {0, 0, 1}, {-rho * a.sin, rho * a.cos, 0}};
}

Vec2f disk_uv(const Disk& s, double r, double phi) {
  double v = (s.radius - r) / (double(s.radius) - s.inner_radius);
  return {float(std::min(phi / phi_limit(s.phi_max), 1.0)), float(std::clamp(v, 0.0, 1.0))};
}

double object_area(const Disk& s) {
  double r = s.radius, inner = s.inner_radius;
  return phi_limit(s.phi_max) / 2 * (r - inner) * (r + inner);
}

// ---- cylinder ----

ObjectPoint cylinder_at(const Cylinder& s, double z, Around a) {
  double r = s.radius, limit = phi_limit(s.phi_max);
  return {{r * a.cos, r * a.sin, z}, {a.cos, a.sin, 0}, {-r * a.sin * limit, r * a.cos * limit, 0}};
}

double object_area(const Cylinder& s) { return phi_limit(s.phi_max) * s.radius * (double(s.z_max) - s.z_min); }

}  // namespace

Sphere clamped(Sphere s) {
  auto [low, high] = std::minmax({s.z_min, s.z_max});
  float r = s.radius;
  s.z_min = std::clamp(low, -r, r), s.z_max = std::clamp(high, -r, r);
  s.phi_max = std::clamp(s.phi_max, 0.0f, 360.0f);
  return s;
}

Disk clamped(Disk s) {
  s.phi_max = std::clamp(s.phi_max, 0.0f, 360.0f);
  return s;
}

Cylinder clamped(Cylinder s) {
  auto [low, high] = std::minmax({s.z_min, s.z_max});
  s.z_min = low, s.z_max = high;
  s.phi_max = std::clamp(s.phi_max, 0.0f, 360.0f);
  return s;
}

Bounds3 bounds(const Sphere& s) { return round_bounds(s.object_to_world, s.radius, s.z_min, s.z_max, true); }
Bounds3 bounds(const Disk& s) { return round_bounds(s.object_to_world, s.radius, s.height, s.height, false); }
Bounds3 bounds(const Cylinder& s) { return round_bounds(s.object_to_world, s.radius, s.z_min, s.z_max, false); }

Ball ball_around(const Sphere& s) {
  const auto& a = s.object_to_world.matrix().m;
  const auto column = [&](int j) { return Vec3d{a[0][j], a[1][j], a[2][j]}; };
  const Vec3d x = column(0), y = column(1), z = column(2), centre = column(3);
  const double longest = std::max({norm(x), norm(y), norm(z)});
  // |M v| <= |v| sqrt(longest^2 + the sum of the products of different columns), by Gershgorin's circles of M^T M.
  const double off = std::max({std::abs(dot(x, y)) + std::abs(dot(x, z)), std::abs(dot(x, y)) + std::abs(dot(y, z)),
                               std::abs(dot(x, z)) + std::abs(dot(y, z))});
  const double radius = s.radius * std::sqrt(longest * longest + off);
  return {to_float(centre), float(radius * (1 + 0x1p-20) + norm(centre) * 0x1p-22)};
}

SurfacePoint<float> surface_point(const Sphere& s, Vec2f uv) {
  return to_world(s.object_to_world, flips(s), sphere_at(s, uv), uv);
}

SurfacePoint<float> surface_point(const Disk& s, Vec2f uv) {
  double r = mix(uv.y, s.radius, s.inner_radius);
  return to_world(s.object_to_world, flips(s), disk_at(s, r, at_azimuth(uv.x * phi_limit(s.phi_max))), uv);
}

SurfacePoint<float> surface_point(const Cylinder& s, Vec2f uv) {
  double z = mix(uv.y, s.z_min, s.z_max);
  return to_world(s.object_to_world, flips(s), cylinder_at(s, z, at_azimuth(uv.x * phi_limit(s.phi_max))), uv);
}

SurfacePoint<float> surface_point(const Sphere& s, const Ray<float>& ray, const ShapeHit& hit) {
  Vec3d n = unit(object_point(s, ray, hit.t));
  double rho = std::sqrt(n.x * n.x + n.y * n.y);
  return to_world(s.object_to_world, flips(s), sphere_at(s, n.z, rho, toward(n.x, n.y, rho)), hit.uv);
}

SurfacePoint<float> surface_point(const Disk& s, const Ray<float>& ray, const ShapeHit& hit) {
  Vec3d p = object_point(s, ray, hit.t);
  double rho = std::sqrt(p.x * p.x + p.y * p.y);
  return to_world(s.object_to_world, flips(s), disk_at(s, rho, toward(p.x, p.y, rho)), hit.uv);
}

SurfacePoint<float> surface_point(const Cylinder& s, const Ray<float>& ray, const ShapeHit& hit) {
  Vec3d p = object_point(s, ray, hit.t);
  ObjectPoint q = cylinder_at(s, p.z, toward(p.x, p.y, std::sqrt(p.x * p.x + p.y * p.y)));
  return to_world(s.object_to_world, flips(s), q, hit.uv);
}

double area(const Sphere& s) {
  if (is_similarity(s.object_to_world)) return object_area(s) * area_stretch(s.object_to_world, {0, 0, 1});
  double r = s.radius;
  return r * integrate_panels(s.z_min, s.z_max, 32, [&](double z) {
           double cos_theta = std::clamp(z / r, -1.0, 1.0), sin_theta = std::sqrt(1 - cos_theta * cos_theta);
           return integrate_panels(0, phi_limit(s.phi_max), 32, [&](double phi) {
             return area_stretch(s.object_to_world, {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
           });
         });
}

double area(const Disk& s) { return object_area(s) * area_stretch(s.object_to_world, {0, 0, 1}); }

double area(const Cylinder& s) {
  if (is_similarity(s.object_to_world)) return object_area(s) * area_stretch(s.object_to_world, {0, 0, 1});
  return s.radius * (double(s.z_max) - s.z_min) * integrate_panels(0, phi_limit(s.phi_max), 64, [&](double phi) {
           return area_stretch(s.object_to_world, {std::cos(phi), std::sin(phi), 0});
         });
}

ShapeSample sample_area(const Sphere& s, Vec2f u) {
  double phi = u.x * phi_limit(s.phi_max), cos_theta = std::clamp(mix(u.y, s.z_min, s.z_max) / s.radius, -1.0, 1.0);
  double sin_theta = std::sqrt((1 - cos_theta) * (1 + cos_theta));
  ObjectPoint q = sphere_at(s, cos_theta, sin_theta, at_azimuth(phi));
  return {to_world(s.object_to_world, flips(s), q, sphere_uv(s, cos_theta, sin_theta, phi)),
          density_on(s.object_to_world, q.n, object_area(s))};
}

ShapeSample sample_area(const Disk& s, Vec2f u) {
  double phi = u.x * phi_limit(s.phi_max), outer = s.radius, inner = s.inner_radius;
  double r = std::sqrt(mix(u.y, outer * outer, inner * inner));
  ObjectPoint q = disk_at(s, r, at_azimuth(phi));
  return {to_world(s.object_to_world, flips(s), q, disk_uv(s, r, phi)),
          density_on(s.object_to_world, q.n, object_area(s))};
}

ShapeSample sample_area(const Cylinder& s, Vec2f u) { return {surface_point(s, u), area_density(s, u)}; }

Density<Area> area_density(const Sphere& s, Vec2f uv) {
  return density_on(s.object_to_world, sphere_at(s, uv).n, object_area(s));
}
Density<Area> area_density(const Disk& s, Vec2f) { return density_on(s.object_to_world, {0, 0, 1}, object_area(s)); }
Density<Area> area_density(const Cylinder& s, Vec2f uv) {
  double phi = uv.x * phi_limit(s.phi_max);
  return density_on(s.object_to_world, {std::cos(phi), std::sin(phi), 0}, object_area(s));
}

}  // namespace montelux
