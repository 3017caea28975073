// The closed set of shapes that are not triangles or curves, and one dispatch for each operation. The contracts are
// those of the members (quadric.h, bilinear.h).
#pragma once
#include <variant>

#include "geometry/bilinear.h"
#include "geometry/quadric.h"

namespace montelux {

using Shape = std::variant<Sphere, Disk, Cylinder, BilinearPatch>;

Bounds3 bounds(const Shape& s);
// A ball in world space that holds the shape: little wider than a sphere that stays round.
Ball ball_around(const Shape& s);
std::optional<ShapeHit> intersect(const Shape& s, const Ray<float>& ray, float t_min);
// At the parameters of a ShapeHit.
SurfacePoint<float> surface_point(const Shape& s, Vec2f uv);
// As above, but with the place along the ray kept: the better choice after `intersect`.
SurfacePoint<float> surface_point(const Shape& s, const Ray<float>& ray, const ShapeHit& hit);
double area(const Shape& s);
ShapeSample sample_area(const Shape& s, Vec2f u);
Density<Area> area_density(const Shape& s, Vec2f uv);

}  // namespace montelux
