#include "texture/bilerp.h"

#include "parameter/fields.h"
#include "texture/maker.h"

namespace montelux {

Fields<BilerpTextureDesc> BilerpTextureDesc::rows() {
  using T = BilerpTextureDesc;
  Fields<T> fields;
  fields.input<ConstantInput>("v00", &T::v00, "", -any_magnitude, any_magnitude);
  fields.input<ConstantInput>("v01", &T::v01, "", -any_magnitude, any_magnitude);
  fields.input<ConstantInput>("v10", &T::v10, "", -any_magnitude, any_magnitude);
  fields.input<ConstantInput>("v11", &T::v11, "", -any_magnitude, any_magnitude);
  fields.part(&T::mapping, rows_of_mapping());
  return fields;
}

template <class V>
TextureId<V> BilerpTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  return maker.add(BilerpTexture{maker.mapping(stated.mapping), maker.value(stated.v00), maker.value(stated.v01),
                                 maker.value(stated.v10), maker.value(stated.v11)});
}

template <class V>
V BilerpTexture<V>::at(const TextureSet&, const TexturePoint& point) const {
  const Vec2f st = apply(mapping, point);
  return (v00 * (1 - st.x) + v10 * st.x) * (1 - st.y) + (v01 * (1 - st.x) + v11 * st.x) * st.y;
}
template <class V>
PackOf<V> BilerpTexture<V>::at(const TextureSet&, const TexturePack& points, TextureMask on) const {
  const Vec2<NativeFloats> st = apply(mapping, points, on);
  const NativeFloats sx = 1.0f - st.x, sy = 1.0f - st.y;
  const auto v = [](const V& x) { return ValueInPack<V>::splat(x); };
  return (v(v00) * sx + v(v10) * st.x) * sy + (v(v01) * sx + v(v11) * st.x) * st.y;
}

template struct BilerpTexture<float>;
template struct BilerpTexture<Rgb>;

}  // namespace montelux
