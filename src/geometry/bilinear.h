// The bilinear patch: the surface (1-u)(1-v) p00 + u(1-v) p10 + (1-u)v p01 + uv p11 over [0, 1]^2.
#pragma once
#include <array>
#include <optional>
#include <span>

#include "geometry/bounds.h"
#include "geometry/mesh.h"
#include "geometry/shape_hit.h"

namespace montelux {

// In world space; corners in the order p00, p10, p01, p11.
struct BilinearPatch {
  std::array<Vec3f, 4> p;
  std::array<Vec2f, 4> uv{{{0, 0}, {1, 0}, {0, 1}, {1, 1}}};   // texture coordinates
  std::optional<std::array<Vec3f, 4>> normals = std::nullopt;  // shading normals; then ng takes their side
  bool flip_normal = false;                                    // without normals, ng is against dp/du x dp/dv
};

// The quadrilateral number `quad` of a mesh in world space.
BilinearPatch patch_of(const Mesh& mesh, std::size_t quad, bool flip_normal);

Bounds3 bounds(const BilinearPatch& s);
// The nearest hit with t_min < t < ray.t_max; hit.uv are the patch's own parameters (Reshetov 2019, "Cool Patches",
// in double precision).
std::optional<ShapeHit> intersect(const BilinearPatch& s, const Ray<float>& ray, float t_min);
// The same for several rays from t = 0, bit for bit, eight at a time; as many hits as rays.
void intersect(const BilinearPatch& s, std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits);
// The point at the patch's own parameters; its field uv holds the texture coordinates and dpdu follows them.
SurfacePoint<float> surface_point(const BilinearPatch& s, Vec2f uv);
SurfacePoint<float> surface_point(const BilinearPatch& s, const Ray<float>& ray, const ShapeHit& hit);
double area(const BilinearPatch& s);
// Samples a bilinear density in the parameters that follows the area element at the corners.
ShapeSample sample_area(const BilinearPatch& s, Vec2f u);
// The density of sample_area at the patch's own parameters.
Density<Area> area_density(const BilinearPatch& s, Vec2f uv);

}  // namespace montelux
