// Sums of octaves of noise.
#pragma once
#include "texture/model.h"
#include "texture/octaves.h"

namespace montelux {

struct FbmTextureDesc {
  OctavesDesc noise{};

  static constexpr std::string_view name = "fbm", meaning = "fractional Brownian motion";
  static constexpr TextureValues values = TextureValues::numbers;
  static Fields<FbmTextureDesc> rows();
};

// In texture space.
template <class V>
struct FbmTexture {
  using Stated = FbmTextureDesc;
  Transform world_to_texture;
  OctavesDesc noise{};

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
};

}  // namespace montelux
