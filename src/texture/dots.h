// Discs at random positions.
#pragma once
#include "texture/model.h"

namespace montelux {

struct DotsTextureDesc {
  ValueInput inside = 1.0f, outside = 0.0f;
  MappingDesc mapping{};

  static constexpr std::string_view name = "dots", meaning = "discs at random positions";
  static constexpr TextureValues values = TextureValues::both;
  static Fields<DotsTextureDesc> rows();
};

// Discs of radius 0.35 at random positions in about two of five cells of size 1.
template <class V>
struct DotsTexture {
  using Stated = DotsTextureDesc;
  Mapping mapping;
  TextureId<V> inside, outside;

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
};

}  // namespace montelux
