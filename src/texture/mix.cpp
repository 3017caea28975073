#include "texture/mix.h"

#include "parameter/fields.h"
#include "texture/maker.h"

namespace montelux {

Fields<MixTextureDesc> MixTextureDesc::rows() {
  using T = MixTextureDesc;
  Fields<T> fields;
  fields.input<ValueInput>("tex1", &T::first, "", -any_magnitude, any_magnitude);
  fields.input<ValueInput>("tex2", &T::second, "", -any_magnitude, any_magnitude);
  fields.input<NumberInput>("amount", &T::amount, "share of tex2", -any_magnitude, any_magnitude);
  return fields;
}

template <class V>
TextureId<V> MixTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  const MixTexture made{maker.of(stated.first), maker.of(stated.second), maker.number(stated.amount)};
  return maker.add_folded(made, made.first, made.second, made.amount);
}

template <class V>
V MixTexture<V>::at(const TextureSet& set, const TexturePoint& point) const {
  return set.blend(first, second, set.number(amount, point), point);
}
template <class V>
PackOf<V> MixTexture<V>::at(const TextureSet& set, const TexturePack& points, TextureMask on) const {
  return set.blend(first, second, set.number(amount, points, on), points, on);
}

template struct MixTexture<float>;
template struct MixTexture<Rgb>;

}  // namespace montelux
