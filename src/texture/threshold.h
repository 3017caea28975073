// 1 where a texture is at least as large as a number, else 0.
#pragma once
#include "texture/model.h"

namespace montelux {

struct ThresholdTextureDesc {
  NumberInput texture = 1.0f;
  float edge = 0.5f;

  static constexpr std::string_view name = "threshold",
                                    meaning =
                                        "1 where a texture is at least as large as a number, else 0 (numbers only; "
                                        "Montelux alone)";
  static constexpr TextureValues values = TextureValues::numbers;
  static Fields<ThresholdTextureDesc> rows();
};

template <class V>
struct ThresholdTexture {
  using Stated = ThresholdTextureDesc;
  NumberTextureId texture;
  float edge = 0.5f;

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
  PackOf<V> at(const TextureSet& set, const TexturePack& points, TextureMask on) const;
};

}  // namespace montelux
