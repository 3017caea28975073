#include "texture/build.h"

#include "texture/table.h"

namespace montelux {

namespace {

template <class V>
V uniform(float x) {
  if constexpr (std::is_same_v<V, float>)
    return x;
  else
    return gray_rgb(x);
}

template <class V>
constexpr const char* kind_of = std::is_same_v<V, float> ? "number" : "spectrum";

std::string in_quotes(std::string_view name) {
  std::string text("\"");
  text.append(name).append("\"");
  return text;
}

}  // namespace

TextureBuilder::TextureBuilder(TextureSet& textures, std::string folder, ToRgb to_rgb, Diagnostics& diagnostics)
    : textures_(textures), folder_(std::move(folder)), to_rgb_(std::move(to_rgb)), diagnostics_(diagnostics) {}

// ---- names, constants and parameters --------------------------------------------------------------------------------

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

// A value that was stated directly; nothing if the parameter holds something else.
template <class V>
std::optional<V> TextureBuilder::value(const Parameter& parameter) const {
  if (const auto* x = std::get_if<std::vector<float>>(&parameter.values); x && !x->empty())
    return uniform<V>(x->front());
  if (const auto* x = std::get_if<std::vector<int>>(&parameter.values); x && !x->empty())
    return uniform<V>(float(x->front()));
  if constexpr (std::is_same_v<V, Rgb>)
    if (const auto* x = std::get_if<std::vector<SpectrumValue>>(&parameter.values); x && !x->empty())
      return to_rgb_(x->front());
  return std::nullopt;
}

template <class V>
std::optional<TextureId<V>> TextureBuilder::if_stated(const Entity& entity, std::string_view name) {
  const Parameter* stated = entity.parameters.find(name);
  return stated ? stated_by<V>(*stated) : std::nullopt;
}

template <class V>
TextureId<V> TextureBuilder::named(const std::string& name, const SourceLocation& where) {
  auto found = names<V>().find(name);
  if (found != names<V>().end()) return found->second;
  std::vector<std::string_view> known;
  for (const auto& [texture, id] : names<V>()) known.push_back(texture);
  const bool other_kind = std::is_same_v<V, float> ? find_spectrum(name).has_value() : find_number(name).has_value();
  diagnostics_.error(
      where, in_quotes(name) + " is not the name of a " + kind_of<V> + " texture stated before",
      other_kind ? "the texture with this name is of the other kind" : std::string(nearest_name(name, known)));
  return constant(uniform<V>(0));
}

template <class V>
std::optional<TextureId<V>> TextureBuilder::stated_by(const Parameter& stated) {
  if (const auto* link = std::get_if<TextureName>(&stated.values)) return named<V>(link->name, stated.where);
  if (std::optional<V> x = value<V>(stated)) return constant(*x);
  diagnostics_.error(
      stated.where, in_quotes(stated.name) + " takes a " + kind_of<V> + " or the name of a " + kind_of<V> + " texture");
  return constant(uniform<V>(0));
}

NumberTextureId TextureBuilder::number(const NumberInput& input) {
  if (const auto* link = input.get<TextureName>()) return named<float>(link->name, input.where);
  return constant(std::get<float>(input.value));
}
SpectrumTextureId TextureBuilder::spectrum(const SpectrumInput& input) {
  if (const auto* link = input.get<TextureName>()) return named<Rgb>(link->name, input.where);
  return constant(to_rgb_(std::get<SpectrumValue>(input.value)));
}

template <class V>
TextureId<V> TextureBuilder::parameter(const Entity& entity, std::string_view name, float otherwise) {
  std::optional<TextureId<V>> stated = if_stated<V>(entity, name);
  return stated ? *stated : constant(uniform<V>(otherwise));
}

NumberTextureId TextureBuilder::number(const Entity& entity, std::string_view name, float otherwise) {
  return parameter<float>(entity, name, otherwise);
}
SpectrumTextureId TextureBuilder::spectrum(const Entity& entity, std::string_view name, Rgb otherwise) {
  std::optional<SpectrumTextureId> stated = if_stated<Rgb>(entity, name);
  return stated ? *stated : constant(otherwise);
}
std::optional<NumberTextureId> TextureBuilder::number_if_stated(const Entity& entity, std::string_view name) {
  return if_stated<float>(entity, name);
}
std::optional<NumberTextureId> TextureBuilder::number_if_stated(const Parameter& stated) {
  return stated_by<float>(stated);
}
std::optional<SpectrumTextureId> TextureBuilder::spectrum_if_stated(const Entity& entity, std::string_view name) {
  return if_stated<Rgb>(entity, name);
}

// ---- textures -------------------------------------------------------------------------------------------------------

// Replaces a texture that was just added by a constant if it depends only on constants.
template <class V>
TextureId<V> TextureBuilder::folded(TextureId<V> id, bool all_constant) {
  return all_constant ? constant(textures_.value(id, TexturePoint{{0, 0}, {0, 0, 0}, {0, 0, 1}})) : id;
}

template <class V>
TextureId<V> TextureBuilder::build_combination(const Entity& entity, const Transform& texture_to_world) {
  using Texture = std::conditional_t<std::is_same_v<V, float>, NumberTexture, SpectrumTexture>;
  auto fixed = [this](auto... ids) { return (textures_.is_constant(ids) && ...); };
  if (entity.type == "scale") {
    ScaleTexture<V> t{parameter<V>(entity, "tex", 1), number(entity, "scale", 1)};
    return folded<V>(textures_.add(Texture(t)), fixed(t.texture, t.factor));
  }
  TextureId<V> first = parameter<V>(entity, "tex1", 0), second = parameter<V>(entity, "tex2", 1);
  if (entity.type == "mix") {
    NumberTextureId amount = number(entity, "amount", 0.5f);
    return folded<V>(textures_.add(Texture(MixTexture<V>{first, second, amount})), fixed(first, second, amount));
  }
  Vec3f direction = texture_to_world.direction(entity.parameters.vec3("dir", {0, 1, 0}));
  if (!(length_squared(direction) > 0)) {
    diagnostics_.error(entity.where, "dir of a directionmix texture must not be zero");
    direction = {0, 1, 0};
  }
  return textures_.add(Texture(DirectionMixTexture<V>{first, second, normalize(direction)}));
}

std::shared_ptr<const TexelImage> TextureBuilder::image(const Entity& entity, std::string_view name,
                                                        std::optional<ColorEncoding> encoding) {
  std::string file = entity.parameters.string(name, "");
  if (file.empty()) {
    diagnostics_.error(entity.where, in_quotes(entity.type) + " needs the parameter " + in_quotes(name));
    return nullptr;
  }
  return image(file, entity.where, encoding);
}

std::shared_ptr<const TexelImage> TextureBuilder::image(const std::string& file, const SourceLocation& where,
                                                        std::optional<ColorEncoding> encoding) {
  Result<std::shared_ptr<const TexelImage>> found = textures_.image(std::filesystem::path(folder_) / file, encoding);
  if (found) return *found;
  diagnostics_.error(where, found.error());
  return nullptr;
}

// Nothing if the image cannot be read, which has been reported.
std::optional<ImageTexture> TextureBuilder::build_image(const Entity& entity, const Transform& texture_to_world) {
  const ParameterList& p = entity.parameters;
  std::string encoding_name = p.string("encoding", ""), wrap_name = p.string("wrap", "repeat");
  std::optional<ColorEncoding> encoding = parse_encoding(encoding_name);
  if (!encoding && !encoding_name.empty())
    diagnostics_.error(entity.where, std::string("unknown encoding ") + in_quotes(encoding_name),
                       "sRGB, linear or gamma X");
  std::optional<Wrap> wrap = parse_wrap(wrap_name);
  if (!wrap)
    diagnostics_.error(entity.where, std::string("unknown wrap mode ") + in_quotes(wrap_name),
                       "repeat, black, clamp or octahedralsphere");
  std::string filter = p.string("filter", "bilinear");
  const bool prefiltered = filter == "trilinear" || filter == "ewa";
  if (prefiltered && !told_of_filter_) {
    told_of_filter_ = true;
    diagnostics_.note(entity.where, "the texture filter " + filter + " is replaced by bilinear at full resolution",
                      "the samples of a pixel average the texture without the bias of a prefilter");
  }
  if (!prefiltered && filter != "bilinear" && filter != "point")
    diagnostics_.error(entity.where, "unknown texture filter \"" + filter + "\"", "point, bilinear, trilinear or ewa");
  std::shared_ptr<const TexelImage> texels = image(entity, "filename", encoding);
  if (!texels) return std::nullopt;
  ImageTexture t;
  t.mapping = build_mapping(entity, texture_to_world, diagnostics_);
  t.image = std::move(texels);
  t.wrap = wrap.value_or(Wrap::repeat), t.nearest = filter == "point";
  t.scale = p.number("scale", 1), t.invert = p.boolean("invert", false);
  if (const std::string channel = p.string("channel", ""); !channel.empty())
    t.channel = int(std::string("rgba").find(channel));
  if (auto tint = p.spectrum("tint")) t.tint = to_rgb_(*tint);
  const char* axes[2] = {"uwrap", "vwrap"};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string fold = p.string(axes[axis], "");
    t.folds[axis] = fold == "clamp" ? Fold::clamp : fold == "mirror" ? Fold::mirror : Fold::none;
  }
  return t;
}

NumberTextureId TextureBuilder::build_threshold(const Entity& entity) {
  const ThresholdTexture t{number(entity, "tex", 1), entity.parameters.number("edge", 0.5f)};
  return folded<float>(textures_.add(NumberTexture(t)), textures_.is_constant(t.texture));
}

template <class V>
TextureId<V> TextureBuilder::build_flat(const Entity& entity, const Transform& texture_to_world) {
  using Texture = std::conditional_t<std::is_same_v<V, float>, NumberTexture, SpectrumTexture>;
  if (entity.type == "imagemap") {
    std::optional<ImageTexture> t = build_image(entity, texture_to_world);
    return t ? textures_.add(Texture(std::move(*t))) : constant(uniform<V>(0));
  }
  Mapping mapping = build_mapping(entity, texture_to_world, diagnostics_);
  if (entity.type == "bilerp") {
    auto corner = [&](const char* name, float otherwise) {
      const Parameter* stated = entity.parameters.find(name);
      return stated ? value<V>(*stated).value_or(uniform<V>(otherwise)) : uniform<V>(otherwise);
    };
    return textures_.add(
        Texture(BilerpTexture<V>{mapping, corner("v00", 0), corner("v01", 1), corner("v10", 0), corner("v11", 1)}));
  }
  if (entity.type == "dots")
    return textures_.add(
        Texture(DotsTexture<V>{mapping, parameter<V>(entity, "inside", 1), parameter<V>(entity, "outside", 0)}));
  int dimension = entity.parameters.integer("dimension", 2);
  if (dimension != 2 && dimension != 3) diagnostics_.error(entity.where, "dimension of a checkerboard must be 2 or 3");
  return textures_.add(Texture(CheckerboardTexture<V>{dimension == 3 ? std::nullopt : std::optional(mapping),
                                                      texture_to_world.inverted(), parameter<V>(entity, "tex1", 1),
                                                      parameter<V>(entity, "tex2", 0)}));
}

NumberTextureId TextureBuilder::build_noise(const Entity& entity, const Transform& texture_to_world) {
  const float roughness = entity.parameters.number("roughness", 0.5f);
  const int octaves = entity.parameters.integer("octaves", 8);
  const Transform to_texture = texture_to_world.inverted();
  if (entity.type == "fbm") return textures_.add(NumberTexture(FbmTexture{to_texture, roughness, octaves}));
  if (entity.type == "wrinkled") return textures_.add(NumberTexture(WrinkledTexture{to_texture, roughness, octaves}));
  return textures_.add(NumberTexture(WindyTexture{to_texture}));
}

template <class V>
auto TextureBuilder::build(const Entity& entity, const Transform& texture_to_world) {
  const std::string& type = entity.type;
  const ParameterList& p = entity.parameters;
  if (type == "constant") return parameter<V>(entity, "value", 1);
  if (type == "scale" || type == "mix" || type == "directionmix") return build_combination<V>(entity, texture_to_world);
  if (type == "imagemap" || type == "bilerp" || type == "dots" || type == "checkerboard")
    return build_flat<V>(entity, texture_to_world);
  if constexpr (std::is_same_v<V, float>) {
    if (type == "fbm" || type == "wrinkled" || type == "windy") return build_noise(entity, texture_to_world);
    if (type == "threshold") return build_threshold(entity);
  } else if (type == "marble") {
    return textures_.add(
        SpectrumTexture(MarbleTexture{texture_to_world.inverted(), p.number("roughness", 0.5f), p.integer("octaves", 8),
                                      p.number("scale", 1), p.number("variation", 0.2f)}));
  }
  const EntitySpec* known = find_entity(texture_table(), type);
  if (!known)
    diagnostics_.error(entity.where, "unknown texture \"" + type + "\"",
                       std::string(nearest_name(type, names_of(texture_table()))));
  else if (!known->later)
    diagnostics_.error(entity.where, "a texture \"" + type + "\" makes " +
                                         (std::is_same_v<V, float> ? "spectra, not numbers" : "numbers, not spectra"));
  return constant(uniform<V>(1));
}

void TextureBuilder::add(const std::string& name, bool is_spectrum, const Entity& entity,
                         const Transform& texture_to_world) {
  if (is_spectrum)
    spectrum_names_[name] = build<Rgb>(entity, texture_to_world);
  else
    number_names_[name] = build<float>(entity, texture_to_world);
}

}  // namespace montelux
