// The textures themselves: plain data that refers to other textures by links. V is float for a texture of numbers and
// Rgb for one of spectra.
#pragma once
#include <array>
#include <memory>
#include <optional>

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

// The weight of `along` is |cos| of the angle between the normal and the direction.
template <class V>
struct DirectionMixTexture {
  TextureId<V> along, across;
  Vec3f direction;  // unit, in world space
};

// scale * image, or 1 minus that and at least 0; spectra are at least 0. t increases upwards in the image.
struct ImageTexture {
  Mapping mapping;
  std::shared_ptr<const TexelImage> image;
  Wrap wrap = Wrap::repeat;
  bool nearest = false;  // else bilinear
  float scale = 1;
  bool invert = false;
  std::optional<int> channel{};  // of numbers: 0 to 2, or 3 for alpha; none: alpha where there is one, else the mean
  std::optional<Rgb> tint{};     // factor of spectra
  std::array<Fold, 2> folds{};   // along s and t

  // Maps positions beyond the edges to positions on the image, by `folds`.
  template <class F>
  MONTELUX_INLINE Vec2<F> folded(const Vec2<F>& st) const {
    if (folds[0] == Fold::none && folds[1] == Fold::none) return st;
    return {folded(st.x, folds[0], image->width()), folded(st.y, folds[1], image->height())};
  }

 private:
  // Between the centres of the outermost texels nothing beyond the edge is looked up.
  template <class F>
  static MONTELUX_INLINE F folded(F s, Fold fold, int size) {
    if (fold == Fold::none) return s;
    if (fold == Fold::mirror) s = F(1.0f) - abs(s - 2.0f * floor(s * 0.5f) - F(1.0f));
    const float half = 0.5f / float(size);
    return clamp(s, half, 1 - half);
  }
};

// 1 where a texture of numbers is at least `edge`, else 0.
struct ThresholdTexture {
  NumberTextureId texture;
  float edge = 0.5f;
};

// Cells of size 1: `even` where the sum of their coordinates is even.
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

// Discs of radius 0.35 at random positions in about two of five cells of size 1.
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
// Waves whose height is controlled by a noise of lower frequency.
struct WindyTexture {
  Transform world_to_texture;
};
// Veins across y: a sine of y perturbed by noise, mapped to a spline of colours (Ebert et al., "Texturing and
// Modeling").
struct MarbleTexture {
  Transform world_to_texture;
  float roughness = 0.5f;
  int octaves = 8;
  float scale = 1, variation = 0.2f;
};

using NumberTexture =
    std::variant<ConstantTexture<float>, ScaleTexture<float>, MixTexture<float>, DirectionMixTexture<float>,
                 ImageTexture, CheckerboardTexture<float>, BilerpTexture<float>, DotsTexture<float>, FbmTexture,
                 WrinkledTexture, WindyTexture, ThresholdTexture>;
using SpectrumTexture =
    std::variant<ConstantTexture<Rgb>, ScaleTexture<Rgb>, MixTexture<Rgb>, DirectionMixTexture<Rgb>, ImageTexture,
                 CheckerboardTexture<Rgb>, BilerpTexture<Rgb>, DotsTexture<Rgb>, MarbleTexture>;

}  // namespace montelux
