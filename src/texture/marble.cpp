#include "texture/marble.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "texture/maker.h"
#include "texture/noise.h"

namespace montelux {

namespace {

Rgb marble_color(float t) {
  constexpr std::array<Rgb, 9> colors{{{{0.58f, 0.58f, 0.6f}},
                                       {{0.58f, 0.58f, 0.6f}},
                                       {{0.58f, 0.58f, 0.6f}},
                                       {{0.5f, 0.5f, 0.5f}},
                                       {{0.6f, 0.59f, 0.58f}},
                                       {{0.58f, 0.58f, 0.6f}},
                                       {{0.58f, 0.58f, 0.6f}},
                                       {{0.2f, 0.2f, 0.33f}},
                                       {{0.58f, 0.58f, 0.6f}}}};
  constexpr int segments = int(colors.size()) - 3;
  // A cubic Bezier segment by de Casteljau's scheme.
  t = clamp(t, 0.0f, 1.0f);
  int first = std::min(int(t * segments), segments - 1);
  float u = t * segments - float(first);
  std::array<Rgb, 4> p{colors[first], colors[first + 1], colors[first + 2], colors[first + 3]};
  for (int n = 3; n > 0; --n)
    for (int i = 0; i < n; ++i) p[i] = p[i] * (1 - u) + p[i + 1] * u;
  return p[0] * 1.5f;
}

}  // namespace

Fields<MarbleTextureDesc> MarbleTextureDesc::rows() {
  using T = MarbleTextureDesc;
  Fields<T> fields;
  fields.part(&T::noise, OctavesDesc::rows());
  fields.number("scale", &T::scale, "factor of space", -any_magnitude, any_magnitude);
  fields.number("variation", &T::variation, "strength of the veins", -any_magnitude, any_magnitude);
  return fields;
}

template <class V>
TextureId<V> MarbleTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  return maker.add(MarbleTexture{maker.world_to_texture(), stated});
}

template <class V>
V MarbleTexture<V>::at(const TextureSet&, const TexturePoint& point) const {
  const Vec3f p = world_to_texture.point(point.p) * stated.scale;
  const OctavesDesc& noise = stated.noise;
  const float vein = p.y + stated.variation * fractional_brownian_motion(p, noise.roughness, noise.octaves);
  return marble_color(0.5f + 0.5f * std::sin(vein));
}

template struct MarbleTexture<Rgb>;

}  // namespace montelux
