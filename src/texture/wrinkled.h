// Sums of octaves of the magnitude of noise.
#pragma once
#include "texture/model.h"
#include "texture/octaves.h"

namespace montelux {

struct WrinkledTextureDesc {
  OctavesDesc noise{};

  static constexpr std::string_view name = "wrinkled", meaning = "sums of absolute values of noise";
  static constexpr TextureValues values = TextureValues::numbers;
  static Fields<WrinkledTextureDesc> rows();
};

// In texture space.
template <class V>
struct WrinkledTexture {
  using Stated = WrinkledTextureDesc;
  Transform world_to_texture;
  OctavesDesc noise{};

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
};

}  // namespace montelux
