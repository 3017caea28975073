#include "geometry/shape.h"

namespace montelux {

Bounds3 bounds(const Shape& s) {
  return std::visit([](const auto& x) { return bounds(x); }, s);
}
Ball ball_around(const Shape& s) {
  if (const auto* sphere = std::get_if<Sphere>(&s)) return ball_around(*sphere);
  const Bounds3 box = bounds(s);
  const Vec3f centre = (box.low + box.high) * 0.5f, reach = max(box.high - centre, centre - box.low);
  return {centre, length(reach) * (1 + 0x1p-20f)};
}
std::optional<ShapeHit> intersect(const Shape& s, const Ray<float>& ray, float t_min) {
  return std::visit([&](const auto& x) { return intersect(x, ray, t_min); }, s);
}
void intersect(const Shape& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits) {
  std::visit([&](const auto& x) { intersect(x, rays, hits); }, s);
}
SurfacePoint<float> surface_point(const Shape& s, Vec2f uv) {
  return std::visit([&](const auto& x) { return surface_point(x, uv); }, s);
}
SurfacePoint<float> surface_point(const Shape& s, const Ray<float>& ray, const ShapeHit& hit) {
  return std::visit([&](const auto& x) { return surface_point(x, ray, hit); }, s);
}
double area(const Shape& s) {
  return std::visit([](const auto& x) { return area(x); }, s);
}
ShapeSample sample_area(const Shape& s, Vec2f u) {
  return std::visit([&](const auto& x) { return sample_area(x, u); }, s);
}
Density<Area> area_density(const Shape& s, Vec2f uv) {
  return std::visit([&](const auto& x) { return area_density(x, uv); }, s);
}

}  // namespace montelux
