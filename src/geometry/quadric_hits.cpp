// Where rays meet quadrics.
#include <algorithm>

#include "geometry/double_ray.h"
#include "geometry/quadric_parameters.h"
#include "math/functions.h"

namespace montelux {

namespace {

// The ray in object space, with the same parameter.
template <class S, class D>
DoubleRay<D> object_ray(const S& s, const DoubleRay<D>& ray) {
  const Matrix4& m = s.object_to_world.inverse_matrix();
  return {transform_point(m, ray.o), transform_direction(m, ray.d), ray.t_min, ray.t_max};
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
bool within_azimuth(float phi_max, double x, double y) { return phi_max >= 360 || azimuth(x, y) <= phi_limit(phi_max); }
DoubleMask within_azimuth(float phi_max, const Doubles& x, const Doubles& y) {
  DoubleMask within{};
  for (int k = 0; k < double_lanes; ++k) set_lane(within, k, within_azimuth(phi_max, lane(x, k), lane(y, k)));
  return within;
}

bool is_whole(const Sphere& s) { return s.z_min <= -s.radius && s.z_max >= s.radius && s.phi_max >= 360; }

// u of a shape whose azimuth is not limited. Single precision, which has parameters to 1e-7 of their range, is enough
// for whole shapes; the parameters of parts are computed in double precision, one by one.
template <class F>
F whole_turn(F x, F y) {
  const F turns = atan2(y, x) * inv_two_pi;
  return min(select(turns < F(0.0f), turns + F(1.0f), turns), F(1.0f));
}
template <class D>
D azimuth_parameter(float phi_max, const D& x, const D& y) {
  D u;
  if (phi_max >= 360)
    u = to_double(whole_turn(to_single(x), to_single(y)));
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
    const Vec3<D> direction = p * (D(1.0) / max(length_of(p), D(1e-300)));
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
    hit.u = to_double(whole_turn(x, y));
    // From the south pole, where theta is pi, to the north pole.
    hit.v = to_double(max(decltype(x + x)(1.0f) - atan2(sqrt(x * x + y * y), z) * inv_pi, decltype(x + x)(0.0f)));
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

}  // namespace montelux
