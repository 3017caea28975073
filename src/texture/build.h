// From stated textures and parameters to a TextureSet.
#pragma once
#include <functional>
#include <map>
#include <set>
#include <string>

#include "texture/description.h"
#include "texture/texture_set.h"

namespace montelux {

// Adds textures to a set, by name, and converts the parameters of other objects (materials, shapes) to textures.
// What is not supported is reported and replaced by a constant.
class TextureBuilder {
 public:
  // Converts a stated colour to linear sRGB.
  using ToRgb = std::function<Rgb(const SpectrumValue&)>;

  // folder: the folder to which image file names are relative. The set and the diagnostics must outlive the builder.
  TextureBuilder(TextureSet& textures, std::string folder, ToRgb to_rgb, Diagnostics& diagnostics);

  // Adds a texture under a name that later textures, parameters and find_... may use. Numbers and spectra have separate
  // names; a name that is stated again means the new texture from there on.
  void add(const TextureDesc& texture);

  // The input as a texture. A name that does not exist is reported, and the texture is 0.
  NumberTextureId number(const NumberInput& input) { return texture_of<float>(input); }
  SpectrumTextureId spectrum(const SpectrumInput& input) { return texture_of<Rgb>(input); }
  // As a texture of values V.
  template <class V>
  TextureId<V> value(const ValueInput& input) {
    return texture_of<V>(input);
  }
  Rgb rgb(const SpectrumValue& stated) const { return to_rgb_(stated); }

  NumberTextureId constant(float value);
  SpectrumTextureId constant(Rgb value);

  // The named texture; nothing if there is none.
  std::optional<NumberTextureId> find_number(std::string_view name) const;
  std::optional<SpectrumTextureId> find_spectrum(std::string_view name) const;

  // The image in a file, relative to the folder; if it cannot be read, reports that and returns null.
  std::shared_ptr<const TexelImage> image(const std::string& file, const SourceLocation& where,
                                          std::optional<ColorEncoding> encoding = std::nullopt);

  TextureSet& textures() { return textures_; }

 private:
  template <class V>
  using Names = std::map<std::string, TextureId<V>, std::less<>>;

  template <class V>
  friend class TextureMaker;
  template <class V>
  TextureId<V> made(const TextureDesc& texture);
  template <class V, class... T>
  TextureId<V> texture_of(const Input<T...>& input);
  template <class V>
  TextureId<V> named(const std::string& name, const SourceLocation& where);
  template <class V>
  V stated(float value) const;
  template <class V>
  V stated(const SpectrumValue& value) const;
  template <class V>
  const Names<V>& names() const;

  TextureSet& textures_;
  std::string folder_;
  ToRgb to_rgb_;
  Diagnostics& diagnostics_;
  Names<float> number_names_;
  Names<Rgb> spectrum_names_;
  std::map<std::array<std::uint32_t, rgb_size>, SpectrumTextureId> spectrum_constants_;  // by the bits
  std::map<std::uint32_t, NumberTextureId> number_constants_;
  std::set<std::string> noted_;  // subjects
};

}  // namespace montelux
