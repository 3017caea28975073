#include "geometry/quadric.h"

#include <algorithm>
#include <numbers>

#include "geometry/double_ray.h"
#include "geometry/quadrature.h"
#include "math/functions.h"

namespace montelux {

namespace {

constexpr double pi_d = std::numbers::pi;

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

double phi_limit(float phi_max) { return phi_max * (pi_d / 180); }

// Azimuth in [0, 2 pi).
double azimuth(double x, double y) {
  double phi = std::atan2(y, x);
  return phi < 0 ? phi + 2 * pi_d : phi;
}

template <class S>
bool flips(const S& s) {
  return s.reverse_orientation != s.object_to_world.swaps_handedness();
}

// The ray in object space, with the same parameter.
template <class S, class D>
DoubleRay<D> object_ray(const S& s, const DoubleRay<D>& ray) {
  const Matrix4& m = s.object_to_world.inverse_matrix();
  return {transform_point(m, ray.o), transform_direction(m, ray.d), ray.t_min, ray.t_max};
}
template <class S>
Vec3d object_point(const S& s, const Ray<float>& ray, float t) {
  return object_ray(s, DoubleRay<double>{to_double(ray.o), to_double(ray.d), 0, 0}).at(t);
}

template <class D>
D length_of(D x, D y) {
  return sqrt(x * x + y * y);
}
template <class D>
D length_of(const Vec3<D>& p) {
  return sqrt(dot(p, p));
}

// Valid where they exist.
template <class D>
struct Roots {
  MaskOfDouble<D> exist;
  D near, far;
};

// Solutions of |o + t d| = r. The discriminant uses the point nearest to the centre, which avoids cancellation for far
// origins, and the smaller root follows from the product of both (Haines et al. 2019, "Precision Improvements for
// Ray/Sphere Intersection").
template <class D>
Roots<D> solve_round(const Vec3<D>& o, const Vec3<D>& d, double r) {
  const D dd = dot(d, d), middle = -dot(o, d) / dd, nearest = length_of(o + d * middle);
  const D discriminant = (r - nearest) * (r + nearest), half = sqrt(max(discriminant, D(0.0)) / dd);
  const D q = middle + copysign(half, middle), distance = length_of(o);
  const D other = (distance - r) * (distance + r) / (dd * q);
  const MaskOfDouble<D> exist = (dd > D(0.0)) & (discriminant >= D(0.0)) & (q != D(0.0));
  return {exist, min(q, other), max(q, other)};
}

// Where the azimuth of (x, y) is within phi_max; computed for shapes in part alone.
inline bool within_azimuth(float phi_max, double x, double y) {
  return phi_max >= 360 || azimuth(x, y) <= phi_limit(phi_max);
}
DoubleMask within_azimuth(float phi_max, const Doubles& x, const Doubles& y) {
  DoubleMask within;
  for (int k = 0; k < double_lanes; ++k)
    within.v[k] = within_azimuth(phi_max, lane(x, k), lane(y, k)) ? std::int64_t(-1) : std::int64_t(0);
  return within;
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

struct PolarRange {
  double low, high;  // polar angles at z_min and z_max: v runs from low to high
};
PolarRange polar_range(const Sphere& s) {
  auto angle = [&](float z) { return std::acos(std::clamp(double(z) / s.radius, -1.0, 1.0)); };
  return {angle(s.z_min), angle(s.z_max)};
}

bool is_whole(const Sphere& s) { return s.z_min <= -s.radius && s.z_max >= s.radius && s.phi_max >= 360; }

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

Vec2f sphere_uv(const Sphere& s, double cos_theta, double sin_theta, double phi) {
  PolarRange range = polar_range(s);
  double theta = std::atan2(sin_theta, cos_theta);
  double v = range.low == range.high ? 0 : (theta - range.low) / (range.high - range.low);
  return {float(std::min(phi / phi_limit(s.phi_max), 1.0)), float(std::clamp(v, 0.0, 1.0))};
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

namespace {

// The parameters of points of whole shapes are computed in single precision, which has them to 1e-7 of their range;
// those of parts in double precision, one by one.
MONTELUX_INLINE float to_single(double x) { return float(x); }
MONTELUX_INLINE Floats<double_lanes> to_single(const Doubles& x) {
  return __builtin_convertvector(x.v, Floats<double_lanes>::Vector);
}
MONTELUX_INLINE void set_double(double& to, float x) { to = x; }
MONTELUX_INLINE void set_double(Doubles& to, const Floats<double_lanes>& x) {
  to = __builtin_convertvector(x.v, Doubles::Vector);
}

// u of a shape whose azimuth is not limited.
template <class F>
F whole_turn(F x, F y) {
  const F turns = atan2(y, x) * inv_two_pi;
  return min(select(turns < F(0.0f), turns + F(1.0f), turns), F(1.0f));
}
template <class D>
D azimuth_parameter(float phi_max, const D& x, const D& y) {
  D u;
  if (phi_max >= 360)
    set_double(u, whole_turn(to_single(x), to_single(y)));
  else
    for (int k = 0; k < lanes_of_double<D>; ++k)
      set_lane(u, k, std::min(azimuth(lane(x, k), lane(y, k)) / phi_limit(phi_max), 1.0));
  return u;
}

// The nearest hits; the ray is in object space.
template <class D>
DoubleHits<D> nearest_hits(const Sphere& s, const DoubleRay<D>& ray) {
  const Roots<D> roots = solve_round(ray.o, ray.d, s.radius);
  DoubleHits<D> hit{{}, roots.near, roots.near, roots.near};
  Vec3<D> n{};
  for (const D& t : {roots.near, roots.far}) {
    MaskOfDouble<D> on = roots.exist & ray.contains(t) & !hit.found;
    if (!any(on)) continue;
    const Vec3<D> p = ray.at(t);
    const Vec3<D> direction = p * (D(1.0) / length_of(p));
    if (!is_whole(s)) {
      const D z = direction.z * D(s.radius);
      if (s.z_min > -s.radius) on = on & (z >= D(s.z_min));
      if (s.z_max < s.radius) on = on & (z <= D(s.z_max));
      on = on & within_azimuth(s.phi_max, direction.x, direction.y);
    }
    hit.found = hit.found | on;
    hit.t = select(on, t, hit.t);
    n = {select(on, direction.x, n.x), select(on, direction.y, n.y), select(on, direction.z, n.z)};
  }
  if (!any(hit.found)) return hit;
  if (is_whole(s)) {
    const auto x = to_single(n.x), y = to_single(n.y), z = to_single(n.z);
    set_double(hit.u, whole_turn(x, y));
    // From the south pole, where theta is pi, to the north pole.
    set_double(hit.v, max(decltype(x + x)(1.0f) - atan2(sqrt(x * x + y * y), z) * inv_pi, decltype(x + x)(0.0f)));
    return hit;
  }
  for (int k = 0; k < lanes_of_double<D>; ++k) {
    const double x = lane(n.x, k), y = lane(n.y, k);
    const Vec2f uv = sphere_uv(s, lane(n.z, k), std::hypot(x, y), azimuth(x, y));
    set_lane(hit.u, k, uv.x), set_lane(hit.v, k, uv.y);
  }
  return hit;
}

template <class D>
DoubleHits<D> nearest_hits(const Disk& s, const DoubleRay<D>& ray) {
  const D t = (s.height - ray.o.z) / ray.d.z;
  const Vec3<D> p = ray.at(t);
  const D rho = length_of(p.x, p.y);
  const MaskOfDouble<D> found = (ray.d.z != D(0.0)) & ray.contains(t) & (rho <= D(s.radius)) &
                                (rho >= D(s.inner_radius)) & within_azimuth(s.phi_max, p.x, p.y);
  if (!any(found)) return {found, t, t, t};
  const D v = (s.radius - rho) / D(double(s.radius) - s.inner_radius);
  return {found, t, azimuth_parameter(s.phi_max, p.x, p.y), min(max(v, D(0.0)), D(1.0))};
}

template <class D>
DoubleHits<D> nearest_hits(const Cylinder& s, const DoubleRay<D>& ray) {
  const D zero = 0.0;
  const Roots<D> roots = solve_round(Vec3<D>{ray.o.x, ray.o.y, zero}, Vec3<D>{ray.d.x, ray.d.y, zero}, s.radius);
  DoubleHits<D> hit{{}, roots.near, zero, zero};
  Vec3<D> at{zero, zero, zero};
  for (const D& t : {roots.near, roots.far}) {
    const Vec3<D> p = ray.at(t);
    const MaskOfDouble<D> on = roots.exist & ray.contains(t) & !hit.found & (p.z >= D(s.z_min)) & (p.z <= D(s.z_max)) &
                               within_azimuth(s.phi_max, p.x, p.y);
    hit.found = hit.found | on;
    hit.t = select(on, t, hit.t);
    at = {select(on, p.x, at.x), select(on, p.y, at.y), select(on, p.z, at.z)};
  }
  if (!any(hit.found)) return hit;
  hit.u = azimuth_parameter(s.phi_max, at.x, at.y);
  hit.v = (at.z - s.z_min) / D(double(s.z_max) - s.z_min);
  return hit;
}

template <class S>
std::optional<ShapeHit> hit_of(const S& s, const Ray<float>& ray, float t_min) {
  return hit_after(ray, t_min, [&](const DoubleRay<double>& r) { return nearest_hits(s, object_ray(s, r)); });
}
template <class S>
void hits_of_rays(const S& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits) {
  hits_of(rays, hits, [&](const auto& r) { return nearest_hits(s, object_ray(s, r)); });
}

}  // namespace

std::optional<ShapeHit> intersect(const Sphere& s, const Ray<float>& ray, float t_min) { return hit_of(s, ray, t_min); }
std::optional<ShapeHit> intersect(const Disk& s, const Ray<float>& ray, float t_min) { return hit_of(s, ray, t_min); }
std::optional<ShapeHit> intersect(const Cylinder& s, const Ray<float>& ray, float t_min) {
  return hit_of(s, ray, t_min);
}

void intersect(const Sphere& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits) {
  hits_of_rays(s, rays, hits);
}
void intersect(const Disk& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits) {
  hits_of_rays(s, rays, hits);
}
void intersect(const Cylinder& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits) {
  hits_of_rays(s, rays, hits);
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
  double rho = length_of(n.x, n.y);
  return to_world(s.object_to_world, flips(s), sphere_at(s, n.z, rho, toward(n.x, n.y, rho)), hit.uv);
}

SurfacePoint<float> surface_point(const Disk& s, const Ray<float>& ray, const ShapeHit& hit) {
  Vec3d p = object_point(s, ray, hit.t);
  double rho = length_of(p.x, p.y);
  return to_world(s.object_to_world, flips(s), disk_at(s, rho, toward(p.x, p.y, rho)), hit.uv);
}

SurfacePoint<float> surface_point(const Cylinder& s, const Ray<float>& ray, const ShapeHit& hit) {
  Vec3d p = object_point(s, ray, hit.t);
  ObjectPoint q = cylinder_at(s, p.z, toward(p.x, p.y, length_of(p.x, p.y)));
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
