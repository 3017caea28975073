// Textures: numbers or spectra that vary over a surface. V is float for a texture of numbers and Rgb for one of
// spectra.
#pragma once
#include <cstdint>

#include "color/spectrum.h"
#include "math/vec.h"

namespace montelux {

// Links into a TextureSet.
enum class NumberTextureId : std::uint32_t {};
enum class SpectrumTextureId : std::uint32_t {};

template <class V>
struct TextureLink;
template <>
struct TextureLink<float> {
  using Id = NumberTextureId;
};
template <>
struct TextureLink<Rgb> {
  using Id = SpectrumTextureId;
};
template <class V>
using TextureId = typename TextureLink<V>::Id;

// What textures of a model can be of.
enum class TextureValues { both, numbers, spectra };
template <class V>
constexpr bool can_be_of(TextureValues values) {
  return values == TextureValues::both ||
         values == (std::is_same_v<V, float> ? TextureValues::numbers : TextureValues::spectra);
}

// Where a texture is looked up: surface parameters, and the point and normal in world space.
struct TexturePoint {
  Vec2f uv;
  Vec3f p;
  Vec3f n;
};
// The same in every lane.
template <class F>
struct TexturePoints {
  Vec2<F> uv;
  Vec3<F> p, n;
};
using TexturePack = TexturePoints<NativeFloats>;
using TextureMask = Mask<NativeFloats>;

// A value V, float or Rgb, in every lane.
template <class V>
struct ValueInPack;
template <>
struct ValueInPack<float> {
  using Type = NativeFloats;
  static Type splat(float x) { return Type(x); }
};
template <>
struct ValueInPack<Rgb> {
  using Type = RgbOf<NativeFloats>;
  static Type splat(const Rgb& x) { return montelux::splat<NativeFloats>(x); }
};
template <class V>
using PackOf = typename ValueInPack<V>::Type;

inline TexturePoint point_of(const TexturePack& points, int k) {
  return {lane(points.uv, k), lane(points.p, k), lane(points.n, k)};
}

// Looks up a texture point by point, where it has no form over lanes.
template <class V, class Texture, class Set>
PackOf<V> point_by_point(const Texture& texture, const Set& set, const TexturePack& points, TextureMask on) {
  PackOf<V> values = ValueInPack<V>::splat(V{});
  for_each_lane(on, [&](int k) { set_lane(values, k, texture.at(set, point_of(points, k))); });
  return values;
}

}  // namespace montelux
