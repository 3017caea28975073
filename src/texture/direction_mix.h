// Interpolation between two textures by the angle of the normal.
#pragma once
#include "texture/model.h"

namespace montelux {

struct DirectionMixTextureDesc {
  ValueInput along = 0.0f, across = 1.0f;
  Vec3f direction{0, 1, 0};  // in the space of the texture; not zero

  static constexpr std::string_view name = "directionmix", meaning = "interpolation by the angle of the normal";
  static constexpr TextureValues values = TextureValues::both;
  static Fields<DirectionMixTextureDesc> rows();
};

// The weight of `along` is |cos| of the angle between the normal and the direction.
template <class V>
struct DirectionMixTexture {
  using Stated = DirectionMixTextureDesc;
  TextureId<V> along, across;
  Vec3f direction;  // unit, in world space

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
  PackOf<V> at(const TextureSet& set, const TexturePack& points, TextureMask on) const;
};

}  // namespace montelux
