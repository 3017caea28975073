#include "texture/checkerboard.h"

#include "parameter/fields.h"
#include "texture/maker.h"

namespace montelux {

namespace {

template <class F>
Mask<F> is_even(F whole) {
  return whole * 0.5f == floor(whole * 0.5f);
}

}  // namespace

Fields<CheckerboardTextureDesc> CheckerboardTextureDesc::rows() {
  using T = CheckerboardTextureDesc;
  Fields<T> fields;
  fields.integer("dimension", &T::dimension, "2 or 3", 2, 3);
  fields.input<ValueInput>("tex1", &T::even, "", -any_magnitude, any_magnitude);
  fields.input<ValueInput>("tex2", &T::odd, "", -any_magnitude, any_magnitude);
  fields.part(&T::mapping, rows_of_mapping(), [](const T& board) { return board.dimension == 2; });
  return fields;
}

template <class V>
TextureId<V> CheckerboardTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  const bool is_solid = stated.dimension == 3;
  return maker.add(CheckerboardTexture{is_solid ? std::nullopt : std::optional(maker.mapping(stated.mapping)),
                                       maker.world_to_texture(), maker.of(stated.even), maker.of(stated.odd)});
}

template <class V>
V CheckerboardTexture<V>::at(const TextureSet& set, const TexturePoint& point) const {
  float cell;
  if (flat) {
    const Vec2f st = apply(*flat, point);
    cell = std::floor(st.x) + std::floor(st.y);
  } else {
    const Vec3f p = world_to_texture.point(point.p);
    cell = std::floor(p.x) + std::floor(p.y) + std::floor(p.z);
  }
  return set.value(is_even(cell) ? even : odd, point);
}
template <class V>
PackOf<V> CheckerboardTexture<V>::at(const TextureSet& set, const TexturePack& points, TextureMask on) const {
  using F = NativeFloats;
  F cell;
  if (flat) {
    const Vec2<F> st = apply(*flat, points, on);
    cell = floor(st.x) + floor(st.y);
  } else {
    const Vec3<F> p = world_to_texture.point(points.p);
    cell = floor(p.x) + floor(p.y) + floor(p.z);
  }
  const TextureMask is_light = is_even(cell);
  const TextureMask in_even = on & is_light, in_odd = on & !is_light;
  if (!any(in_odd)) return set.value(even, points, in_even);
  const PackOf<V> of_odd = set.value(odd, points, in_odd);
  return any(in_even) ? select(in_even, set.value(even, points, in_even), of_odd) : of_odd;
}

template struct CheckerboardTexture<float>;
template struct CheckerboardTexture<Rgb>;

}  // namespace montelux
