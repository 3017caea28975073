// One value everywhere.
#pragma once
#include "texture/model.h"

namespace montelux {

struct ConstantTextureDesc {
  ValueInput value = 1.0f;

  static constexpr std::string_view name = "constant", meaning = "one value everywhere";
  static constexpr TextureValues values = TextureValues::both;
  static Fields<ConstantTextureDesc> rows();
};

template <class V>
struct ConstantTexture {
  using Stated = ConstantTextureDesc;
  V value;

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet&, const TexturePoint&) const { return value; }
  PackOf<V> at(const TextureSet&, const TexturePack&, TextureMask) const { return ValueInPack<V>::splat(value); }
};

}  // namespace montelux
