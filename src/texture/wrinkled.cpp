#include "texture/wrinkled.h"

#include "texture/maker.h"
#include "texture/noise.h"

namespace montelux {

Fields<WrinkledTextureDesc> WrinkledTextureDesc::rows() {
  return Fields<WrinkledTextureDesc>().part(&WrinkledTextureDesc::noise, OctavesDesc::rows());
}

template <class V>
TextureId<V> WrinkledTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  return maker.add(WrinkledTexture{maker.world_to_texture(), stated.noise});
}

template <class V>
V WrinkledTexture<V>::at(const TextureSet&, const TexturePoint& point) const {
  return turbulence(world_to_texture.point(point.p), noise.roughness, noise.octaves);
}

template struct WrinkledTexture<float>;

}  // namespace montelux
