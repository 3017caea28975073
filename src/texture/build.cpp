#include "texture/build.h"

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
V TextureBuilder::value(float stated) const {
  return uniform<V>(stated);
}
template <class V>
V TextureBuilder::value(const SpectrumValue& stated) const {
  if constexpr (std::is_same_v<V, Rgb>)
    return to_rgb_(stated);
  else
    return average(to_rgb_(stated));
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
      [&]<class Stated>(const Stated& stated) {
        if constexpr (std::is_same_v<Stated, TextureName>)
          return named<V>(stated.name, input.where);
        else
          return constant(value<V>(stated));
      },
      input.value);
}

template NumberTextureId TextureBuilder::texture_of<float>(const NumberInput&);
template SpectrumTextureId TextureBuilder::texture_of<Rgb>(const SpectrumInput&);

// ---- textures -------------------------------------------------------------------------------------------------------

// Replaces a texture that was just added by a constant if it depends only on constants.
template <class V>
TextureId<V> TextureBuilder::folded(TextureId<V> id, bool all_constant) {
  return all_constant ? constant(textures_.value(id, TexturePoint{{0, 0}, {0, 0, 0}, {0, 0, 1}})) : id;
}

std::shared_ptr<const TexelImage> TextureBuilder::image(const std::string& file, const SourceLocation& where,
                                                        std::optional<ColorEncoding> encoding) {
  Result<std::shared_ptr<const TexelImage>> found = textures_.image(std::filesystem::path(folder_) / file, encoding);
  if (found) return *found;
  diagnostics_.error(where, found.error());
  return nullptr;
}

// Nothing if the image cannot be read, which has been reported.
std::optional<ImageTexture> TextureBuilder::build_image(const ImageTextureDesc& stated, const TextureDesc& texture) {
  const bool prefiltered = stated.filter == TextureFilter::trilinear || stated.filter == TextureFilter::ewa;
  if (prefiltered && !noted_filter_) {
    noted_filter_ = true;
    const std::string name = stated.filter == TextureFilter::ewa ? "ewa" : "trilinear";
    diagnostics_.note(texture.where, "the texture filter " + name + " is replaced by bilinear at full resolution",
                      "the samples of a pixel average the texture without the bias of a prefilter");
  }
  if (stated.file.empty()) {
    diagnostics_.error(texture.where, "an image texture needs the file of an image");
    return std::nullopt;
  }
  std::shared_ptr<const TexelImage> texels = image(stated.file, texture.where, stated.encoding);
  if (!texels) return std::nullopt;
  ImageTexture t;
  t.mapping = build_mapping(stated.mapping, texture.texture_to_world);
  t.image = std::move(texels);
  t.wrap = stated.wrap, t.nearest = stated.filter == TextureFilter::point;
  t.scale = stated.scale, t.invert = stated.invert;
  if (stated.channel) t.channel = int(*stated.channel);
  if (!(stated.tint == gray_value(1))) t.tint = to_rgb_(stated.tint);
  t.folds = stated.folds;
  return t;
}

// Makes one texture of values V, by its model.
template <class V>
struct TextureBuilder::Maker {
  using Texture = std::conditional_t<std::is_same_v<V, float>, NumberTexture, SpectrumTexture>;
  using Id = TextureId<V>;
  TextureBuilder& builder;
  const TextureDesc& texture;

  TextureSet& set() const { return builder.textures_; }
  Id add(Texture made) const { return set().add(std::move(made)); }
  template <class... T>
  Id of(const Input<T...>& input) const {
    return builder.texture_of<V>(input);
  }
  template <class... Ids>
  bool are_constant(Ids... ids) const {
    return (set().is_constant(ids) && ...);
  }
  Mapping mapping(const MappingDesc& stated) const { return build_mapping(stated, texture.texture_to_world); }
  Transform to_texture() const { return texture.texture_to_world.inverted(); }

  Id operator()(const ConstantTextureDesc& t) const { return of(t.value); }
  Id operator()(const ScaleTextureDesc& t) const {
    const ScaleTexture<V> made{of(t.texture), builder.number(t.factor)};
    return builder.folded<V>(add(made), are_constant(made.texture, made.factor));
  }
  Id operator()(const MixTextureDesc& t) const {
    const Id first = of(t.first), second = of(t.second);
    const NumberTextureId amount = builder.number(t.amount);
    return builder.folded<V>(add(MixTexture<V>{first, second, amount}), are_constant(first, second, amount));
  }
  Id operator()(const DirectionMixTextureDesc& t) const {
    const Id along = of(t.along), across = of(t.across);
    Vec3f direction = texture.texture_to_world.direction(t.direction);
    if (!(length_squared(direction) > 0)) {
      builder.diagnostics_.error(texture.where, "dir of a directionmix texture must not be zero");
      direction = {0, 1, 0};
    }
    return add(DirectionMixTexture<V>{along, across, normalize(direction)});
  }
  Id operator()(const ImageTextureDesc& t) const {
    std::optional<ImageTexture> made = builder.build_image(t, texture);
    return made ? add(std::move(*made)) : builder.constant(uniform<V>(0));
  }
  Id operator()(const CheckerboardTextureDesc& t) const {
    const bool is_solid = t.dimension == 3;
    return add(CheckerboardTexture<V>{is_solid ? std::nullopt : std::optional(mapping(t.mapping)), to_texture(),
                                      of(t.even), of(t.odd)});
  }
  Id operator()(const BilerpTextureDesc& t) const {
    const auto corner = [&](const ConstantInput& input) {
      return std::visit([&](const auto& stated) { return builder.value<V>(stated); }, input.value);
    };
    return add(BilerpTexture<V>{mapping(t.mapping), corner(t.v00), corner(t.v01), corner(t.v10), corner(t.v11)});
  }
  Id operator()(const DotsTextureDesc& t) const {
    return add(DotsTexture<V>{mapping(t.mapping), of(t.inside), of(t.outside)});
  }

  // Of numbers alone.
  Id operator()(const ThresholdTextureDesc& t) const {
    if constexpr (std::is_same_v<V, float>) {
      const ThresholdTexture made{builder.number(t.texture), t.edge};
      return builder.folded<V>(add(made), are_constant(made.texture));
    }
    return of_other_kind();
  }
  Id operator()(const FbmTextureDesc& t) const {
    if constexpr (std::is_same_v<V, float>) return add(FbmTexture{to_texture(), t.noise.roughness, t.noise.octaves});
    return of_other_kind();
  }
  Id operator()(const WrinkledTextureDesc& t) const {
    if constexpr (std::is_same_v<V, float>)
      return add(WrinkledTexture{to_texture(), t.noise.roughness, t.noise.octaves});
    return of_other_kind();
  }
  Id operator()(const WindyTextureDesc&) const {
    if constexpr (std::is_same_v<V, float>) return add(WindyTexture{to_texture()});
    return of_other_kind();
  }
  // Of spectra alone.
  Id operator()(const MarbleTextureDesc& t) const {
    if constexpr (std::is_same_v<V, Rgb>)
      return add(MarbleTexture{to_texture(), t.noise.roughness, t.noise.octaves, t.scale, t.variation});
    return of_other_kind();
  }
  Id of_other_kind() const {
    builder.diagnostics_.error(texture.where,
                               "a texture \"" + std::string(name_of(texture.model)) + "\" makes " +
                                   (std::is_same_v<V, float> ? "spectra, not numbers" : "numbers, not spectra"));
    return builder.constant(uniform<V>(1));
  }
};

template <class V>
TextureId<V> TextureBuilder::made(const TextureDesc& texture) {
  return std::visit(Maker<V>{*this, texture}, texture.model);
}

void TextureBuilder::add(const TextureDesc& texture) {
  if (texture.is_spectrum)
    spectrum_names_[texture.name] = made<Rgb>(texture);
  else
    number_names_[texture.name] = made<float>(texture);
}

}  // namespace montelux
