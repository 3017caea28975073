// Spheres, disks and cylinders, whole or in part, with the parameters and parametrisation of pbrt-v4. Each is computed
// in double precision in its own object space, so that thin, huge and far shapes keep their shape.
#pragma once
#include <optional>
#include <span>

#include "geometry/bounds.h"
#include "geometry/shape_hit.h"
#include "math/transform.h"

namespace montelux {

// Around the origin; u is the azimuth over phi_max (degrees), v the polar angle from z_min to z_max.
// z_min <= z_max within [-radius, radius], 0 < phi_max <= 360: ensured by `clamped`.
struct Sphere {
  Transform object_to_world;
  bool reverse_orientation = false;
  float radius = 1, z_min = -1, z_max = 1, phi_max = 360;
};

// In the plane z = height, normal +z; v is 0 at `radius` and 1 at `inner_radius`.
struct Disk {
  Transform object_to_world;
  bool reverse_orientation = false;
  float height = 0, radius = 1, inner_radius = 0, phi_max = 360;
};

// Around the z axis, normal outward, open at both ends; v from z_min to z_max.
struct Cylinder {
  Transform object_to_world;
  bool reverse_orientation = false;
  float radius = 1, z_min = -1, z_max = 1, phi_max = 360;
};

// The same shape with ordered limits in range, clamped as in pbrt.
Sphere clamped(Sphere s);
Disk clamped(Disk s);
Cylinder clamped(Cylinder s);

// A box in world space around the shape, slightly larger than the shape.
Bounds3 bounds(const Sphere& s);
Bounds3 bounds(const Disk& s);
Bounds3 bounds(const Cylinder& s);

// A ball in world space that contains the whole sphere, slightly larger if the sphere remains a sphere.
Ball ball_around(const Sphere& s);

// The nearest hit with t_min < t < ray.t_max of a ray in world space; ray.d need not be unit.
std::optional<ShapeHit> intersect(const Sphere& s, const Ray<float>& ray, float t_min);
std::optional<ShapeHit> intersect(const Disk& s, const Ray<float>& ray, float t_min);
std::optional<ShapeHit> intersect(const Cylinder& s, const Ray<float>& ray, float t_min);
// The same for several rays from t = 0, bit for bit, eight at a time; as many hits as rays.
void intersect(const Sphere& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits);
void intersect(const Disk& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits);
void intersect(const Cylinder& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits);

// The point with parameters uv. ng is outward, reversed if reverse_orientation or (exclusively) the transform
// swaps handedness.
SurfacePoint<float> surface_point(const Sphere& s, Vec2f uv);
SurfacePoint<float> surface_point(const Disk& s, Vec2f uv);
SurfacePoint<float> surface_point(const Cylinder& s, Vec2f uv);

// The point of the shape closest to ray.o + hit.t ray.d, which is accurate for huge shapes too, where uv is coarse.
SurfacePoint<float> surface_point(const Sphere& s, const Ray<float>& ray, const ShapeHit& hit);
SurfacePoint<float> surface_point(const Disk& s, const Ray<float>& ray, const ShapeHit& hit);
SurfacePoint<float> surface_point(const Cylinder& s, const Ray<float>& ray, const ShapeHit& hit);

// World area: closed form where the transform is a similarity (disks: always), else quadrature to about 1e-6.
double area(const Sphere& s);
double area(const Disk& s);
double area(const Cylinder& s);

// Samples a point uniformly by area in object space, hence uniformly in the world under a similarity. u in [0, 1)^2.
ShapeSample sample_area(const Sphere& s, Vec2f u);
ShapeSample sample_area(const Disk& s, Vec2f u);
ShapeSample sample_area(const Cylinder& s, Vec2f u);

// The density with which sample_area draws the point uv.
Density<Area> area_density(const Sphere& s, Vec2f uv);
Density<Area> area_density(const Disk& s, Vec2f uv);
Density<Area> area_density(const Cylinder& s, Vec2f uv);

}  // namespace montelux
