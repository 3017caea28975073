#include "texture/fbm.h"

#include "texture/maker.h"
#include "texture/noise.h"

namespace montelux {

Fields<FbmTextureDesc> FbmTextureDesc::rows() {
  return Fields<FbmTextureDesc>().part(&FbmTextureDesc::noise, OctavesDesc::rows());
}

template <class V>
TextureId<V> FbmTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  return maker.add(FbmTexture{maker.world_to_texture(), stated.noise});
}

template <class V>
V FbmTexture<V>::at(const TextureSet&, const TexturePoint& point) const {
  return fractional_brownian_motion(world_to_texture.point(point.p), noise.roughness, noise.octaves);
}

template struct FbmTexture<float>;

}  // namespace montelux
