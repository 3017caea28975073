// An image.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>

#include "color/transfer.h"
#include "texture/model.h"
#include "texture/texel_image.h"

namespace montelux {

// How texels are interpolated. Prefilters are replaced by bilinear interpolation.
enum class TextureFilter { point, bilinear, trilinear, ewa };
enum class ImageChannel { r, g, b, a };

struct ImageTextureDesc {
  std::string file{};  // it is needed
  Wrap wrap = Wrap::repeat;
  std::array<Fold, 2> folds{};            // along u and v, in place of `wrap`
  std::optional<ImageChannel> channel{};  // of a texture of numbers; none: alpha if there is one, else the mean
  SpectrumValue tint = gray_value(1);     // factor, of a texture of spectra
  float scale = 1;                        // factor
  bool invert = false;                    // 1 - value
  TextureFilter filter = TextureFilter::bilinear;
  std::optional<ColorEncoding> encoding{};  // of images of integers; none: sRGB. Floats are linear
  MappingDesc mapping{};

  static constexpr std::string_view name = "imagemap", meaning = "an image";
  static constexpr TextureValues values = TextureValues::both;
  static Fields<ImageTextureDesc> rows();
};

// scale * image, or 1 minus that and at least 0; spectra are at least 0. t increases upwards in the image.
template <class V>
struct ImageTexture {
  using Stated = ImageTextureDesc;
  Mapping mapping;
  std::shared_ptr<const TexelImage> image;
  Wrap wrap = Wrap::repeat;
  bool nearest = false;  // else bilinear
  float scale = 1;
  bool invert = false;
  std::optional<int> channel{};  // of numbers: 0 to 2, or 3 for alpha; none: alpha where there is one, else the mean
  std::optional<Rgb> tint{};     // factor of spectra
  std::array<Fold, 2> folds{};   // along s and t: positions beyond the edges are mapped to positions on the image

  static TextureId<V> make(const Stated& stated, const TextureMaker<V>& maker);
  V at(const TextureSet& set, const TexturePoint& point) const;
  PackOf<V> at(const TextureSet& set, const TexturePack& points, TextureMask on) const;

 private:
  template <class F>
  Vec2<F> on_image(Vec2<F> st) const;
  float number_at(Vec2f st) const;
};

}  // namespace montelux
