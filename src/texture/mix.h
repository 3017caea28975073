// Interpolation between two textures.
#pragma once
#include "texture/model.h"

namespace montelux {

struct MixTextureDesc {
  ValueInput first = 0.0f, second = 1.0f;
  NumberInput amount = 0.5f;  // share of the second

  static constexpr std::string_view name = "mix", meaning = "interpolation between two textures";
  static constexpr TextureValues values = TextureValues::both;
  static Fields<MixTextureDesc> rows();
};

// (1 - amount) first + amount second.
template <class V>
struct MixTexture {
  using Stated = MixTextureDesc;
  TextureId<V> first, second;
  NumberTextureId amount;

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
  PackOf<V> at(const TextureSet& set, const TexturePack& points, TextureMask on) const;
};

}  // namespace montelux
