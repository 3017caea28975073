#include "scene/scene.h"

#include "mc/random.h"

namespace montelux {

bool Scene::is_opaque(const Hit<float>& hit, const Ray<float>& ray) const {
  const std::uint32_t alpha = geometry.rows[hit.geometry].alpha;
  if (alpha == 0) return true;
  const Vec3f p = ray.o + ray.d * hit.t;
  const float opacity = textures->number(NumberTextureId(alpha - 1), {surface_uv(geometry, hit), p, Vec3f{0, 0, 1}});
  if (opacity >= 1) return true;
  if (opacity <= 0) return false;
  // Half-there surfaces: a number that belongs to this ray and surface decides, so that a ray asked twice is told the
  // same.
  RandomStream<float> random(mix_bits(float_bits(ray.o.x) ^ mix_bits(float_bits(ray.d.x) ^ hit.geometry)),
                             mix_bits(float_bits(ray.o.y) ^ mix_bits(float_bits(ray.d.y) ^ float_bits(ray.o.z))) ^
                                 mix_bits(float_bits(ray.d.z) + hit.primitive));
  return random.next() < opacity;
}

}  // namespace montelux
