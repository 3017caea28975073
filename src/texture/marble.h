// Veins of marble: a sine of y perturbed by noise, mapped to a spline of colours (Ebert et al., "Texturing and
// Modeling").
#pragma once
#include "texture/model.h"
#include "texture/octaves.h"

namespace montelux {

struct MarbleTextureDesc {
  OctavesDesc noise{};
  float scale = 1;         // factor of space
  float variation = 0.2f;  // strength of the veins

  static constexpr std::string_view name = "marble", meaning = "veins of marble (spectra only)";
  static constexpr TextureValues values = TextureValues::spectra;
  static Fields<MarbleTextureDesc> rows();
};

// Across y of texture space.
template <class V>
struct MarbleTexture {
  using Stated = MarbleTextureDesc;
  Transform world_to_texture;
  MarbleTextureDesc stated{};

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
};

}  // namespace montelux
