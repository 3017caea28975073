// All textures of a scene, and their images, each of which is stored once.
#pragma once
#include <filesystem>
#include <functional>
#include <map>

#include "texture/models.h"

namespace montelux {

// An image that will be requested, as TextureSet::image() takes it.
struct ImageRequest {
  std::filesystem::path path;
  std::optional<ColorEncoding> encoding{};
};
// Calls body(i) for each i in [0, count), in any order and on any threads.
using ForEachNumber = std::function<void(std::size_t count, const std::function<void(std::size_t i)>& body)>;

class TextureSet {
 public:
  // A texture may link only to textures that were added before it.
  NumberTextureId add(NumberTexture texture);
  SpectrumTextureId add(SpectrumTexture texture);

  // The value at a point. May be called from any number of threads; allocates nothing.
  float number(NumberTextureId id, const TexturePoint& point) const;
  Rgb color(SpectrumTextureId id, const TexturePoint& point) const;
  float value(NumberTextureId id, const TexturePoint& point) const { return number(id, point); }
  Rgb value(SpectrumTextureId id, const TexturePoint& point) const { return color(id, point); }

  // The same at the points of a pack, bit for bit; idle lanes may contain anything.
  NativeFloats number(NumberTextureId id, const TexturePack& points, TextureMask on) const;
  RgbOf<NativeFloats> color(SpectrumTextureId id, const TexturePack& points, TextureMask on) const;
  NativeFloats value(NumberTextureId id, const TexturePack& points, TextureMask on) const {
    return number(id, points, on);
  }
  RgbOf<NativeFloats> value(SpectrumTextureId id, const TexturePack& points, TextureMask on) const {
    return color(id, points, on);
  }
  float number(NumberTextureId id, const TexturePoints<float>& at, bool) const {
    return number(id, TexturePoint{at.uv, at.p, at.n});
  }
  Rgb color(SpectrumTextureId id, const TexturePoints<float>& at, bool) const {
    return color(id, TexturePoint{at.uv, at.p, at.n});
  }
  // As paths carry it.
  template <class F>
  Spectrum<F> spectrum(SpectrumTextureId id, const TexturePoints<F>& at, Mask<F> on) const {
    return from_rgb(color(id, at, on));
  }

  // (1 - t) a + t b.
  template <class Id>
  auto blend(Id a, Id b, float t, const TexturePoint& point) const {
    return value(a, point) * (1 - t) + value(b, point) * t;
  }
  template <class Id>
  auto blend(Id a, Id b, const NativeFloats& t, const TexturePack& points, TextureMask on) const {
    return value(a, points, on) * NativeFloats(1.0f - t) + value(b, points, on) * t;
  }

  // The value of a texture that is the same everywhere; nothing for one that may vary.
  std::optional<float> constant(NumberTextureId id) const;
  std::optional<Rgb> constant(SpectrumTextureId id) const;
  bool is_constant(NumberTextureId id) const { return constant(id).has_value(); }
  bool is_constant(SpectrumTextureId id) const { return constant(id).has_value(); }

  // The image of a file, read when first requested with this encoding (see TexelImage::read). Not for several threads
  // at a time.
  Result<std::shared_ptr<const TexelImage>> image(const std::filesystem::path& path,
                                                  std::optional<ColorEncoding> encoding = std::nullopt);
  // Reads images before they are requested, on the threads of `for_each`. Those that cannot be read fail when they are
  // requested.
  void read_ahead(const std::vector<ImageRequest>& requests, const ForEachNumber& for_each);
  // The bytes of an image file, which image() uses in place of the file with that path.
  void embed(const std::filesystem::path& path, std::shared_ptr<const std::string> bytes);
  // Memory of the images' texels.
  std::size_t image_bytes() const;

  const std::vector<NumberTexture>& numbers() const { return numbers_; }
  const std::vector<SpectrumTexture>& spectra() const { return spectra_; }

 private:
  using ImageKey = std::pair<std::string, std::string>;  // path and encoding
  static ImageKey key_of(const std::filesystem::path& path, const std::optional<ColorEncoding>& encoding);
  Result<TexelImage> read(const std::filesystem::path& path, const std::optional<ColorEncoding>& encoding) const;

  std::vector<NumberTexture> numbers_;
  std::vector<SpectrumTexture> spectra_;
  std::map<ImageKey, std::shared_ptr<const TexelImage>> images_;
  std::map<std::string, std::shared_ptr<const std::string>> embedded_;  // by path
};

}  // namespace montelux
