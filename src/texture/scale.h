// The product of two textures.
#pragma once
#include "texture/model.h"

namespace montelux {

struct ScaleTextureDesc {
  ValueInput texture = 1.0f;
  NumberInput factor = 1.0f;

  static constexpr std::string_view name = "scale", meaning = "the product of two textures";
  static constexpr TextureValues values = TextureValues::both;
  static Fields<ScaleTextureDesc> rows();
};

template <class V>
struct ScaleTexture {
  using Stated = ScaleTextureDesc;
  TextureId<V> texture;
  NumberTextureId factor;

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
  PackOf<V> at(const TextureSet& set, const TexturePack& points, TextureMask on) const;
};

}  // namespace montelux
