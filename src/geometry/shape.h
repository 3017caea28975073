// The closed set of shapes that are not triangles or curves, with one dispatch for each operation. The contracts are
// those of the members (quadric.h, bilinear.h).
#pragma once
#include <variant>

#include "geometry/bilinear.h"
#include "geometry/quadric.h"

namespace montelux {

using Shape = std::variant<Sphere, Disk, Cylinder, BilinearPatch>;

Bounds3 bounds(const Shape& s);
// A ball in world space that contains the shape: slightly larger for a sphere that remains a sphere.
Ball ball_around(const Shape& s);
std::optional<ShapeHit> intersect(const Shape& s, const Ray<float>& ray, float t_min);
// The same for several rays from t = 0, bit for bit; as many hits as rays.
void intersect(const Shape& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits);
// At the parameters of a ShapeHit.
SurfacePoint<float> surface_point(const Shape& s, Vec2f uv);
// As above, but keeps the position along the ray: preferable after `intersect`.
SurfacePoint<float> surface_point(const Shape& s, const Ray<float>& ray, const ShapeHit& hit);
double area(const Shape& s);
ShapeSample sample_area(const Shape& s, Vec2f u);
Density<Area> area_density(const Shape& s, Vec2f uv);

}  // namespace montelux
