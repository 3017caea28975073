// Textures: numbers or spectra that vary over a surface. Evaluated one point at a time; the pack loops over its lanes.
#pragma once
#include "color/spectrum.h"
#include "math/vec.h"

namespace montelux {

// Links into a TextureSet.
enum class NumberTextureId : std::uint32_t {};
enum class SpectrumTextureId : std::uint32_t {};

// Where a texture is looked up: surface parameters, and the point and normal in world space.
struct TexturePoint {
  Vec2f uv;
  Vec3f p;
  Vec3f n;
};

}  // namespace montelux
