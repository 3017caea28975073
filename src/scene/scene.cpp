#include "scene/scene.h"

#include "mc/random.h"

namespace montelux {

namespace {

// For partially transparent surfaces: numbers that depend on ray and surface, so that a repeated query agrees.
RandomStream<float> numbers_of(const Hit<float>& hit, const Ray<float>& ray) {
  return {mix_bits(float_bits(ray.o.x) ^ mix_bits(float_bits(ray.d.x) ^ hit.geometry)),
          mix_bits(float_bits(ray.o.y) ^ mix_bits(float_bits(ray.d.y) ^ float_bits(ray.o.z))) ^
              mix_bits(float_bits(ray.d.z) + hit.primitive)};
}

}  // namespace

bool Scene::is_opaque(const Hit<float>& hit, const Ray<float>& local, RayUse use) const {
  const GeometryRow& row = geometry.rows[hit.geometry];
  if (row.alpha != 0) {
    const float opacity = textures->number(NumberTextureId(row.alpha - 1),
                                           {surface_uv(geometry, hit), local.o + local.d * hit.t, Vec3f{0, 0, 1}});
    if (opacity <= 0 || (opacity < 1 && numbers_of(hit, local).at(0) >= opacity)) return false;
  }
  if (use == RayUse::path || (row.flags & GeometryRow::open_to_some_shadow_rays) == 0) return true;
  const SurfacePoint<float> at = point_of_local_ray(geometry, local, hit);
  return !materials.is_interface_at(row.material, {at.uv, at.p, at.ns}, numbers_of(hit, local).at(1));
}

}  // namespace montelux
