#include "texture/dots.h"

#include "parameter/fields.h"
#include "texture/maker.h"
#include "texture/noise.h"

namespace montelux {

namespace {

bool in_dot(Vec2f st) {
  constexpr float radius = 0.35f, shift = 0.5f - radius;
  auto noise = [](float x, float y) { return gradient_noise({x, y, 0.5f}); };
  float s = std::floor(st.x + 0.5f), t = std::floor(st.y + 0.5f);
  if (noise(s + 0.5f, t + 0.5f) <= 0) return false;
  // The disc stays inside its cell.
  float dx = st.x - (s + shift * noise(s + 1.5f, t + 2.8f));
  float dy = st.y - (t + shift * noise(s + 4.5f, t + 9.8f));
  return dx * dx + dy * dy < radius * radius;
}

}  // namespace

Fields<DotsTextureDesc> DotsTextureDesc::rows() {
  using T = DotsTextureDesc;
  Fields<T> fields;
  fields.input<ValueInput>("inside", &T::inside, "", -any_magnitude, any_magnitude);
  fields.input<ValueInput>("outside", &T::outside, "", -any_magnitude, any_magnitude);
  fields.part(&T::mapping, rows_of_mapping());
  return fields;
}

template <class V>
TextureId<V> DotsTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  return maker.add(DotsTexture{maker.mapping(stated.mapping), maker.of(stated.inside), maker.of(stated.outside)});
}

template <class V>
V DotsTexture<V>::at(const TextureSet& set, const TexturePoint& point) const {
  return set.value(in_dot(apply(mapping, point)) ? inside : outside, point);
}

template struct DotsTexture<float>;
template struct DotsTexture<Rgb>;

}  // namespace montelux
