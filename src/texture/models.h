// The textures themselves: plain data, in which other textures are links. V is float for a texture of numbers and Rgb
// for one of spectra.
#pragma once
#include <memory>

#include "texture/mapping.h"
#include "texture/texel_image.h"

namespace montelux {

template <class V>
struct TextureLink;
template <>
struct TextureLink<float> {
  using Id = NumberTextureId;
};
template <>
struct TextureLink<Rgb> {
  using Id = SpectrumTextureId;
};
template <class V>
using TextureId = typename TextureLink<V>::Id;

template <class V>
struct ConstantTexture {
  V value;
};

template <class V>
struct ScaleTexture {
  TextureId<V> texture;
  NumberTextureId factor;
};

// (1 - amount) first + amount second.
template <class V>
struct MixTexture {
  TextureId<V> first, second;
  NumberTextureId amount;
};

// |cos| of the normal to the direction is the share of `along`.
template <class V>
struct DirectionMixTexture {
  TextureId<V> along, across;
  Vec3f direction;  // unit, in world space
};

// scale * image, or 1 less that and then not below 0; spectra are never below 0. t runs up the image.
struct ImageTexture {
  Mapping mapping;
  std::shared_ptr<const TexelImage> image;
  Wrap wrap = Wrap::repeat;
  bool nearest = false;  // else bilinear
  float scale = 1;
  bool invert = false;
};

// Cells of size 1: `even` where their coordinates add up to an even number.
template <class V>
struct CheckerboardTexture {
  std::optional<Mapping> flat;  // absent: cubes in texture space
  Transform world_to_texture;
  TextureId<V> even, odd;
};

// Bilinear in (s, t); the first digit is s, the second t.
template <class V>
struct BilerpTexture {
  Mapping mapping;
  V v00, v01, v10, v11;
};

// Discs of radius 0.35 at random places of about two in five of the cells of size 1.
template <class V>
struct DotsTexture {
  Mapping mapping;
  TextureId<V> inside, outside;
};

// Sums of noise in texture space.
struct FbmTexture {
  Transform world_to_texture;
  float roughness = 0.5f;
  int octaves = 8;
};
struct WrinkledTexture {
  Transform world_to_texture;
  float roughness = 0.5f;
  int octaves = 8;
};
// Waves whose height a slower noise governs.
struct WindyTexture {
  Transform world_to_texture;
};
// Veins across y: a sine of y that noise disturbs, through a spline of colours (Ebert et al., "Texturing and
// Modeling").
struct MarbleTexture {
  Transform world_to_texture;
  float roughness = 0.5f;
  int octaves = 8;
  float scale = 1, variation = 0.2f;
};

using NumberTexture = std::variant<ConstantTexture<float>, ScaleTexture<float>, MixTexture<float>,
                                   DirectionMixTexture<float>, ImageTexture, CheckerboardTexture<float>,
                                   BilerpTexture<float>, DotsTexture<float>, FbmTexture, WrinkledTexture, WindyTexture>;
using SpectrumTexture =
    std::variant<ConstantTexture<Rgb>, ScaleTexture<Rgb>, MixTexture<Rgb>, DirectionMixTexture<Rgb>, ImageTexture,
                 CheckerboardTexture<Rgb>, BilerpTexture<Rgb>, DotsTexture<Rgb>, MarbleTexture>;

}  // namespace montelux
