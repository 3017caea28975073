#include "texture/maker.h"

namespace montelux {

namespace {

template <class V>
V uniform(float x) {
  if constexpr (std::is_same_v<V, float>)
    return x;
  else
    return gray_rgb(x);
}

std::string in_quotes(std::string_view name) {
  std::string text("\"");
  text.append(name).append("\"");
  return text;
}

}  // namespace

TextureBuilder::TextureBuilder(TextureSet& textures, std::string folder, ToRgb to_rgb, Diagnostics& diagnostics)
    : textures_(textures), folder_(std::move(folder)), to_rgb_(std::move(to_rgb)), diagnostics_(diagnostics) {}

// ---- names, constants and inputs --------------------------------------------------------------------------------

template <>
const TextureBuilder::Names<float>& TextureBuilder::names<float>() const {
  return number_names_;
}
template <>
const TextureBuilder::Names<Rgb>& TextureBuilder::names<Rgb>() const {
  return spectrum_names_;
}

std::optional<NumberTextureId> TextureBuilder::find_number(std::string_view name) const {
  auto found = number_names_.find(name);
  return found == number_names_.end() ? std::nullopt : std::optional(found->second);
}
std::optional<SpectrumTextureId> TextureBuilder::find_spectrum(std::string_view name) const {
  auto found = spectrum_names_.find(name);
  return found == spectrum_names_.end() ? std::nullopt : std::optional(found->second);
}

NumberTextureId TextureBuilder::constant(float value) {
  auto [place, is_new] = number_constants_.try_emplace(float_bits(value));
  if (is_new) place->second = textures_.add(NumberTexture(ConstantTexture<float>{value}));
  return place->second;
}
SpectrumTextureId TextureBuilder::constant(Rgb value) {
  std::array<std::uint32_t, rgb_size> key;
  for (int c = 0; c < rgb_size; ++c) key[c] = float_bits(value[c]);
  auto [place, is_new] = spectrum_constants_.try_emplace(key);
  if (is_new) place->second = textures_.add(SpectrumTexture(ConstantTexture<Rgb>{value}));
  return place->second;
}

// A value that was stated directly. A spectrum is of a texture of spectra, as the checks have made sure.
template <class V>
V TextureBuilder::stated(float value) const {
  return uniform<V>(value);
}
template <class V>
V TextureBuilder::stated(const SpectrumValue& value) const {
  if constexpr (std::is_same_v<V, Rgb>)
    return to_rgb_(value);
  else
    return average(to_rgb_(value));
}

template <class V>
TextureId<V> TextureBuilder::named(const std::string& name, const SourceLocation& where) {
  constexpr const char* kind = std::is_same_v<V, float> ? "number" : "spectrum";
  auto found = names<V>().find(name);
  if (found != names<V>().end()) return found->second;
  std::vector<std::string_view> known;
  for (const auto& [texture, id] : names<V>()) known.push_back(texture);
  const bool other_kind = std::is_same_v<V, float> ? find_spectrum(name).has_value() : find_number(name).has_value();
  diagnostics_.error(
      where, in_quotes(name) + " is not the name of a " + kind + " texture stated before",
      other_kind ? "the texture with this name is of the other kind" : std::string(nearest_name(name, known)));
  return constant(uniform<V>(0));
}

template <class V, class... T>
TextureId<V> TextureBuilder::texture_of(const Input<T...>& input) {
  return std::visit(
      [&]<class Stated>(const Stated& value) {
        if constexpr (std::is_same_v<Stated, TextureName>)
          return named<V>(value.name, input.where);
        else
          return constant(stated<V>(value));
      },
      input.value);
}

template NumberTextureId TextureBuilder::texture_of<float>(const NumberInput&);
template SpectrumTextureId TextureBuilder::texture_of<Rgb>(const SpectrumInput&);
template NumberTextureId TextureBuilder::texture_of<float>(const ValueInput&);
template SpectrumTextureId TextureBuilder::texture_of<Rgb>(const ValueInput&);

// ---- textures -------------------------------------------------------------------------------------------------------

std::shared_ptr<const TexelImage> TextureBuilder::image(const std::string& file, const SourceLocation& where,
                                                        std::optional<ColorEncoding> encoding) {
  Result<std::shared_ptr<const TexelImage>> found = textures_.image(std::filesystem::path(folder_) / file, encoding);
  if (found) return *found;
  diagnostics_.error(where, found.error());
  return nullptr;
}

template <class V>
TextureId<V> TextureMaker<V>::constant(float value) const {
  return builder_.constant(uniform<V>(value));
}
template <class V>
V TextureMaker<V>::value(const ConstantInput& input) const {
  return std::visit([&](const auto& value) { return builder_.template stated<V>(value); }, input.value);
}
template <class V>
TextureId<V> TextureMaker<V>::folded(TextureId<V> id) const {
  return builder_.constant(builder_.textures().value(id, TexturePoint{{0, 0}, {0, 0, 0}, {0, 0, 1}}));
}
template <class V>
void TextureMaker<V>::error(std::string message) const {
  builder_.diagnostics_.error(texture_.where, std::move(message));
}
template <class V>
void TextureMaker<V>::note_once(const std::string& subject, std::string message, std::string reason) const {
  if (builder_.noted_.insert(subject).second)
    builder_.diagnostics_.note(texture_.where, std::move(message), std::move(reason));
}
template class TextureMaker<float>;
template class TextureMaker<Rgb>;

namespace {

// The model of the list that a scene states.
template <class V, template <class> class Model>
TextureId<V> made_by(const typename Model<V>::Stated& stated, const TextureMaker<V>& maker) {
  if constexpr (can_be_of<V>(Model<V>::Stated::values)) return Model<V>::make(stated, maker);
  maker.error("a texture " + in_quotes(stated.name) + " makes " +
              (std::is_same_v<V, float> ? "spectra, not numbers" : "numbers, not spectra"));
  return maker.constant(1);
}
template <class V, template <class> class... Model>
TextureId<V> made_of(TextureList<Model...>, const TextureModel& model, const TextureMaker<V>& maker) {
  TextureId<V> id{};
  const auto try_model = [&]<template <class> class M>() {
    const auto* stated = std::get_if<typename M<V>::Stated>(&model);
    if (stated) id = made_by<V, M>(*stated, maker);
    return stated != nullptr;
  };
  (void)(try_model.template operator()<Model>() || ...);
  return id;
}

}  // namespace

template <class V>
TextureId<V> TextureBuilder::made(const TextureDesc& texture) {
  return made_of<V>(TextureModels(), texture.model, TextureMaker<V>(*this, texture));
}

void TextureBuilder::add(const TextureDesc& texture) {
  if (texture.is_spectrum)
    spectrum_names_[texture.name] = made<Rgb>(texture);
  else
    number_names_[texture.name] = made<float>(texture);
}

}  // namespace montelux
