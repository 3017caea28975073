#include "texture/threshold.h"

#include "parameter/fields.h"
#include "texture/maker.h"

namespace montelux {

Fields<ThresholdTextureDesc> ThresholdTextureDesc::rows() {
  using T = ThresholdTextureDesc;
  Fields<T> fields;
  fields.input<NumberInput>("tex", &T::texture, "", -any_magnitude, any_magnitude);
  fields.number("edge", &T::edge, "", -any_magnitude, any_magnitude);
  return fields;
}

template <class V>
TextureId<V> ThresholdTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  const ThresholdTexture made{maker.number(stated.texture), stated.edge};
  return maker.add_folded(made, made.texture);
}

template <class V>
V ThresholdTexture<V>::at(const TextureSet& set, const TexturePoint& point) const {
  return set.number(texture, point) >= edge ? 1.0f : 0.0f;
}
template <class V>
PackOf<V> ThresholdTexture<V>::at(const TextureSet& set, const TexturePack& points, TextureMask on) const {
  using F = NativeFloats;
  return select(set.number(texture, points, on) >= F(edge), F(1.0f), F(0.0f));
}

template struct ThresholdTexture<float>;

}  // namespace montelux
