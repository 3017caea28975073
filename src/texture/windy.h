// Waves whose height is controlled by a noise of lower frequency.
#pragma once
#include "texture/model.h"

namespace montelux {

struct WindyTextureDesc {
  static constexpr std::string_view name = "windy", meaning = "waves of varying height";
  static constexpr TextureValues values = TextureValues::numbers;
  static Fields<WindyTextureDesc> rows();
};

// In texture space.
template <class V>
struct WindyTexture {
  using Stated = WindyTextureDesc;
  Transform world_to_texture;

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
};

}  // namespace montelux
