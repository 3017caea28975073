#include "texture/constant.h"

#include "parameter/fields.h"
#include "texture/maker.h"

namespace montelux {

Fields<ConstantTextureDesc> ConstantTextureDesc::rows() {
  Fields<ConstantTextureDesc> fields;
  fields.input<ValueInput>("value", &ConstantTextureDesc::value, "", -any_magnitude, any_magnitude);
  return fields;
}

template <class V>
TextureId<V> ConstantTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  return maker.of(stated.value);
}

template struct ConstantTexture<float>;
template struct ConstantTexture<Rgb>;

}  // namespace montelux
