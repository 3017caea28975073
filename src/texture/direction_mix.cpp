#include "texture/direction_mix.h"

#include "parameter/fields.h"
#include "texture/maker.h"

namespace montelux {

Fields<DirectionMixTextureDesc> DirectionMixTextureDesc::rows() {
  using T = DirectionMixTextureDesc;
  Fields<T> fields;
  fields.input<ValueInput>("tex1", &T::along, "along dir", -any_magnitude, any_magnitude);
  fields.input<ValueInput>("tex2", &T::across, "across dir", -any_magnitude, any_magnitude);
  fields.vector("dir", ParameterType::vector3, &T::direction, "direction");
  return fields;
}

template <class V>
TextureId<V> DirectionMixTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  const TextureId<V> along = maker.of(stated.along), across = maker.of(stated.across);
  Vec3f direction = maker.to_world().direction(stated.direction);
  if (!(length_squared(direction) > 0)) {
    maker.error("dir of a directionmix texture must not be zero");
    direction = {0, 1, 0};
  }
  return maker.add(DirectionMixTexture{along, across, normalize(direction)});
}

template <class V>
V DirectionMixTexture<V>::at(const TextureSet& set, const TexturePoint& point) const {
  return set.blend(across, along, abs_dot(point.n, direction), point);
}
template <class V>
PackOf<V> DirectionMixTexture<V>::at(const TextureSet& set, const TexturePack& points, TextureMask on) const {
  return set.blend(across, along, abs_dot(points.n, splat<NativeFloats>(direction)), points, on);
}

template struct DirectionMixTexture<float>;
template struct DirectionMixTexture<Rgb>;

}  // namespace montelux
