// Checks of size 1, in the plane or in space.
#pragma once
#include <optional>

#include "texture/model.h"

namespace montelux {

struct CheckerboardTextureDesc {
  int dimension = 2;  // 2, by the mapping, or 3, in the space of the texture
  ValueInput even = 1.0f, odd = 0.0f;
  MappingDesc mapping{};

  static constexpr std::string_view name = "checkerboard", meaning = "checks of size 1";
  static constexpr TextureValues values = TextureValues::both;
  static Fields<CheckerboardTextureDesc> rows();
};

// `even` where the sum of the cell's coordinates is even.
template <class V>
struct CheckerboardTexture {
  using Stated = CheckerboardTextureDesc;
  std::optional<Mapping> flat;  // absent: cubes in texture space
  Transform world_to_texture;
  TextureId<V> even, odd;

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
  PackOf<V> at(const TextureSet& set, const TexturePack& points, TextureMask on) const;
};

}  // namespace montelux
