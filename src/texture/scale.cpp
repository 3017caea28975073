#include "texture/scale.h"

#include "parameter/fields.h"
#include "texture/maker.h"

namespace montelux {

Fields<ScaleTextureDesc> ScaleTextureDesc::rows() {
  using T = ScaleTextureDesc;
  Fields<T> fields;
  fields.input<ValueInput>("tex", &T::texture, "", -any_magnitude, any_magnitude);
  fields.input<NumberInput>("scale", &T::factor, "factor", -any_magnitude, any_magnitude);
  return fields;
}

template <class V>
TextureId<V> ScaleTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  const ScaleTexture made{maker.of(stated.texture), maker.number(stated.factor)};
  return maker.add_folded(made, made.texture, made.factor);
}

template <class V>
V ScaleTexture<V>::at(const TextureSet& set, const TexturePoint& point) const {
  return set.value(texture, point) * set.number(factor, point);
}
template <class V>
PackOf<V> ScaleTexture<V>::at(const TextureSet& set, const TexturePack& points, TextureMask on) const {
  return set.value(texture, points, on) * set.number(factor, points, on);
}

template struct ScaleTexture<float>;
template struct ScaleTexture<Rgb>;

}  // namespace montelux
