// Bilinear interpolation of four values.
#pragma once
#include "texture/model.h"

namespace montelux {

// Of the values at four corners (u, v).
struct BilerpTextureDesc {
  ConstantInput v00 = 0.0f, v01 = 1.0f, v10 = 0.0f, v11 = 1.0f;
  MappingDesc mapping{};

  static constexpr std::string_view name = "bilerp", meaning = "bilinear interpolation of four corner values";
  static constexpr TextureValues values = TextureValues::both;
  static Fields<BilerpTextureDesc> rows();
};

// In (s, t); the first digit is s, the second t.
template <class V>
struct BilerpTexture {
  using Stated = BilerpTextureDesc;
  Mapping mapping;
  V v00, v01, v10, v11;

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
  PackOf<V> at(const TextureSet& set, const TexturePack& points, TextureMask on) const;
};

}  // namespace montelux
