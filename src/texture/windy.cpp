#include "texture/windy.h"

#include "parameter/fields.h"
#include "texture/maker.h"
#include "texture/noise.h"

namespace montelux {

Fields<WindyTextureDesc> WindyTextureDesc::rows() { return {}; }

template <class V>
TextureId<V> WindyTexture<V>::make(const Stated&, const TextureMaker<V>& maker) {
  return maker.add(WindyTexture{maker.world_to_texture()});
}

template <class V>
V WindyTexture<V>::at(const TextureSet&, const TexturePoint& point) const {
  const Vec3f p = world_to_texture.point(point.p);
  const float strength = fractional_brownian_motion(p * 0.1f, 0.5f, 3);
  return std::abs(strength) * fractional_brownian_motion(p, 0.5f, 6);
}

template struct WindyTexture<float>;

}  // namespace montelux
