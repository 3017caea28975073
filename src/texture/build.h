// From stated textures and parameters to a TextureSet.
#pragma once
#include <functional>
#include <map>
#include <string>

#include "parameter/input.h"
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
  void add(const std::string& name, bool is_spectrum, const Entity& entity, const Transform& texture_to_world);

  // The parameter as a texture, whether it was stated as a value or as the name of a texture; the constant `otherwise`
  // if it is absent.
  NumberTextureId number(const Entity& entity, std::string_view parameter, float otherwise);
  SpectrumTextureId spectrum(const Entity& entity, std::string_view parameter, Rgb otherwise);
  NumberTextureId number(const NumberInput& input);
  SpectrumTextureId spectrum(const SpectrumInput& input);
  // Nothing if the parameter is absent.
  std::optional<NumberTextureId> number_if_stated(const Entity& entity, std::string_view parameter);
  std::optional<NumberTextureId> number_if_stated(const Parameter& stated);
  std::optional<SpectrumTextureId> spectrum_if_stated(const Entity& entity, std::string_view parameter);

  NumberTextureId constant(float value);
  SpectrumTextureId constant(Rgb value);

  // The named texture; nothing if there is none.
  std::optional<NumberTextureId> find_number(std::string_view name) const;
  std::optional<SpectrumTextureId> find_spectrum(std::string_view name) const;

  // The image in the file named by a string parameter, relative to the folder; if it cannot be read, reports that and
  // returns null.
  std::shared_ptr<const TexelImage> image(const Entity& entity, std::string_view parameter,
                                          std::optional<ColorEncoding> encoding = std::nullopt);
  std::shared_ptr<const TexelImage> image(const std::string& file, const SourceLocation& where,
                                          std::optional<ColorEncoding> encoding = std::nullopt);

  TextureSet& textures() { return textures_; }

 private:
  template <class V>
  using Names = std::map<std::string, TextureId<V>, std::less<>>;

  template <class V>
  auto build(const Entity& entity, const Transform& texture_to_world);
  template <class V>
  TextureId<V> build_combination(const Entity& entity, const Transform& texture_to_world);
  template <class V>
  TextureId<V> build_flat(const Entity& entity, const Transform& texture_to_world);
  NumberTextureId build_threshold(const Entity& entity);
  NumberTextureId build_noise(const Entity& entity, const Transform& texture_to_world);
  std::optional<ImageTexture> build_image(const Entity& entity, const Transform& texture_to_world);
  template <class V>
  TextureId<V> parameter(const Entity& entity, std::string_view name, float otherwise);
  template <class V>
  std::optional<V> value(const Parameter& parameter) const;
  template <class V>
  std::optional<TextureId<V>> if_stated(const Entity& entity, std::string_view name);
  template <class V>
  std::optional<TextureId<V>> stated_by(const Parameter& stated);
  // The texture with that name; if there is none, reports that and returns black.
  template <class V>
  TextureId<V> named(const std::string& name, const SourceLocation& where);
  template <class V>
  TextureId<V> folded(TextureId<V> id, bool all_constant);
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
  bool told_of_filter_ = false;
};

}  // namespace montelux
