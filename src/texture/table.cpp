#include "texture/table.h"

namespace montelux {

namespace {

using enum ParameterType;
using S = TextureDesc;

constexpr double unlimited = 1e30;

// The member of a texture, or of a part of it.
template <class Texture, class T>
Fields<S>::Place<T> of(T Texture::*member) {
  return [member](S& texture) -> T& { return std::get<Texture>(texture.model).*member; };
}
template <class Texture, class Part, class T>
Fields<S>::Place<T> of(Part Texture::*part, T Part::*member) {
  return [part, member](S& texture) -> T& { return (std::get<Texture>(texture.model).*part).*member; };
}

Model<S> model(std::string_view meaning, TextureModel texture, Fields<S> fields) {
  const std::string_view name = name_of(texture);
  return {name, meaning, {"", false, std::move(texture)}, std::move(fields)};
}

bool is_planar_map(const S& texture) {
  const auto* board = std::get_if<CheckerboardTextureDesc>(&texture.model);
  return !board || board->dimension == 2;
}

// The map from a point to (s, t).
template <class Texture>
void mapping(Fields<S>& fields) {
  using M = MappingDesc;
  const auto at = [](auto M::*member) { return of(&Texture::mapping, member); };
  const auto is_of = [](MappingKind kind) {
    return [kind](const S& texture) {
      return std::get<Texture>(texture.model).mapping.kind == kind && is_planar_map(texture);
    };
  };
  const auto is_scaled = [is_of](const S& texture) {
    return is_of(MappingKind::uv)(texture) && !std::get<Texture>(texture.model).mapping.uv_matrix;
  };
  const auto is_shifted = [is_of, is_scaled](const S& texture) {
    return is_scaled(texture) || is_of(MappingKind::planar)(texture);
  };
  fields
      .choice<MappingKind>("mapping", at(&M::kind), "map from a point to (s, t)",
                           {{"uv", MappingKind::uv},
                            {"spherical", MappingKind::spherical},
                            {"cylindrical", MappingKind::cylindrical},
                            {"planar", MappingKind::planar}})
      .only_if(is_planar_map);
  fields.number("uscale", at(&M::u_scale), "factor of u", -unlimited, unlimited).only_if(is_scaled);
  fields.number("vscale", at(&M::v_scale), "factor of v", -unlimited, unlimited).only_if(is_scaled);
  fields.number("udelta", at(&M::u_delta), "added to u", -unlimited, unlimited).only_if(is_shifted);
  fields.number("vdelta", at(&M::v_delta), "added to v", -unlimited, unlimited).only_if(is_shifted);
  fields
      .list<6>("uvmatrix", at(&M::uv_matrix),
               "a b c d e f: s = a u + b v + c, t = d u + e v + f, instead of the four (Montelux alone)", -unlimited,
               unlimited)
      .only_if(is_of(MappingKind::uv));
  fields.vector("v1", vector3, at(&M::s_axis), "s axis of the planar mapping").only_if(is_of(MappingKind::planar));
  fields.vector("v2", vector3, at(&M::t_axis), "t axis of the planar mapping").only_if(is_of(MappingKind::planar));
}

// ---- combinations ---------------------------------------------------------------------------------------------------

Model<S> constant() {
  Fields<S> fields;
  fields.input<ValueInput>("value", of(&ConstantTextureDesc::value), "", -unlimited, unlimited);
  return model("one value everywhere", ConstantTextureDesc{}, fields);
}

Model<S> scale() {
  using T = ScaleTextureDesc;
  Fields<S> fields;
  fields.input<ValueInput>("tex", of(&T::texture), "", -unlimited, unlimited);
  fields.input<NumberInput>("scale", of(&T::factor), "factor", -unlimited, unlimited);
  return model("the product of two textures", T{}, fields);
}

Model<S> mix() {
  using T = MixTextureDesc;
  Fields<S> fields;
  fields.input<ValueInput>("tex1", of(&T::first), "", -unlimited, unlimited);
  fields.input<ValueInput>("tex2", of(&T::second), "", -unlimited, unlimited);
  fields.input<NumberInput>("amount", of(&T::amount), "share of tex2", -unlimited, unlimited);
  return model("interpolation between two textures", T{}, fields);
}

Model<S> threshold() {
  using T = ThresholdTextureDesc;
  Fields<S> fields;
  fields.input<NumberInput>("tex", of(&T::texture), "", -unlimited, unlimited);
  fields.number("edge", of(&T::edge), "", -unlimited, unlimited);
  return model("1 where a texture is at least as large as a number, else 0 (numbers only; Montelux alone)", T{},
               fields);
}

Model<S> direction_mix() {
  using T = DirectionMixTextureDesc;
  Fields<S> fields;
  fields.input<ValueInput>("tex1", of(&T::along), "along dir", -unlimited, unlimited);
  fields.input<ValueInput>("tex2", of(&T::across), "across dir", -unlimited, unlimited);
  fields.vector("dir", vector3, of(&T::direction), "direction");
  return model("interpolation by the angle of the normal", T{}, fields);
}

// ---- in the plane ---------------------------------------------------------------------------------------------------

const NamedValues<Fold> folds{{"repeat", Fold::none}, {"clamp", Fold::clamp}, {"mirror", Fold::mirror}};

template <std::size_t axis>
void fold(Fields<S>& fields, std::string_view name, const char* meaning) {
  using T = ImageTextureDesc;
  fields
      .choice<Fold>(
          name, [](S& texture) -> Fold& { return std::get<T>(texture.model).folds[axis]; }, meaning, folds)
      .only_if([](const S& texture) {
        const T& image = std::get<T>(texture.model);
        return image.folds[axis] != Fold::none || image.wrap == Wrap::repeat;
      });
}

Model<S> image() {
  using T = ImageTextureDesc;
  Fields<S> fields;
  fields.words("filename", of(&T::file), "the image");
  fields.choice<Wrap>("wrap", of(&T::wrap), "outside the image",
                      {{"repeat", Wrap::repeat},
                       {"black", Wrap::black},
                       {"clamp", Wrap::clamp},
                       {"octahedralsphere", Wrap::octahedral}});
  fold<0>(fields, "uwrap", "along u, where it is not repeat instead of wrap (Montelux alone)");
  fold<1>(fields, "vwrap", "along v, where it is not repeat instead of wrap (Montelux alone)");
  fields.optional_choice<ImageChannel>(
      "channel", of(&T::channel), "for numbers; default alpha, or the mean if there is none (Montelux alone)",
      {{"r", ImageChannel::r}, {"g", ImageChannel::g}, {"b", ImageChannel::b}, {"a", ImageChannel::a}});
  fields.spectrum("tint", of(&T::tint), "factor of spectra (Montelux alone)", 0, unlimited);
  fields.number("scale", of(&T::scale), "factor of the values", -unlimited, unlimited);
  fields.flag("invert", of(&T::invert), "1 - value");
  fields.choice<TextureFilter>("filter", of(&T::filter), "interpolation",
                               {{"point", TextureFilter::point},
                                {"bilinear", TextureFilter::bilinear},
                                {"trilinear", TextureFilter::trilinear},
                                {"ewa", TextureFilter::ewa}});
  ParameterSpec anisotropy{"maxanisotropy", {number}, "for ewa; default 8", 0, unlimited};
  anisotropy.later = true;
  fields.other(anisotropy);
  fields.text(
      "encoding", "of integers: sRGB, linear or 'gamma x'; default sRGB; images of floats are linear",
      [](const std::string& text, S& texture) -> Status {
        // The checks have reported any other text.
        std::get<T>(texture.model).encoding = parse_encoding(text);
        return Done{};
      },
      {}, {},
      [](const S& texture) {
        const auto& encoding = std::get<T>(texture.model).encoding;
        return encoding ? to_string(*encoding) : std::string();
      });
  mapping<T>(fields);
  return model("an image", T{}, fields);
}

Model<S> checkerboard() {
  using T = CheckerboardTextureDesc;
  Fields<S> fields;
  fields.integer("dimension", of(&T::dimension), "2 or 3", 2, 3);
  fields.input<ValueInput>("tex1", of(&T::even), "", -unlimited, unlimited);
  fields.input<ValueInput>("tex2", of(&T::odd), "", -unlimited, unlimited);
  mapping<T>(fields);
  return model("checks of size 1", T{}, fields);
}

Model<S> bilerp() {
  using T = BilerpTextureDesc;
  Fields<S> fields;
  fields.input<ConstantInput>("v00", of(&T::v00), "", -unlimited, unlimited);
  fields.input<ConstantInput>("v01", of(&T::v01), "", -unlimited, unlimited);
  fields.input<ConstantInput>("v10", of(&T::v10), "", -unlimited, unlimited);
  fields.input<ConstantInput>("v11", of(&T::v11), "", -unlimited, unlimited);
  mapping<T>(fields);
  return model("bilinear interpolation of four corner values", T{}, fields);
}

Model<S> dots() {
  using T = DotsTextureDesc;
  Fields<S> fields;
  fields.input<ValueInput>("inside", of(&T::inside), "", -unlimited, unlimited);
  fields.input<ValueInput>("outside", of(&T::outside), "", -unlimited, unlimited);
  mapping<T>(fields);
  return model("discs at random positions", T{}, fields);
}

Model<S> ptex() {
  Fields<S> fields;
  fields.other({"filename", {string}, "the file"});
  fields.other({"encoding", {string}, "default gamma 2.2"});
  fields.other({"scale", {number}, "default 1"});
  return {"ptex", "a per-face texture", {}, fields, true, "constant"};
}

// ---- in space -------------------------------------------------------------------------------------------------------

template <class Texture>
void octaves(Fields<S>& fields) {
  fields.integer("octaves", of(&Texture::noise, &OctavesDesc::octaves), "octaves of noise", 1, 64);
  fields.number("roughness", of(&Texture::noise, &OctavesDesc::roughness), "falloff of the octaves", 0, unlimited);
}

template <class Texture>
Model<S> noise(std::string_view meaning) {
  Fields<S> fields;
  octaves<Texture>(fields);
  return model(meaning, Texture{}, fields);
}

Model<S> marble() {
  using T = MarbleTextureDesc;
  Fields<S> fields;
  octaves<T>(fields);
  fields.number("scale", of(&T::scale), "factor of space", -unlimited, unlimited);
  fields.number("variation", of(&T::variation), "strength of the veins", -unlimited, unlimited);
  return model("veins of marble (spectra only)", T{}, fields);
}

}  // namespace

std::string_view name_of(const TextureModel& model) {
  struct Name {
    std::string_view operator()(const ConstantTextureDesc&) const { return "constant"; }
    std::string_view operator()(const ScaleTextureDesc&) const { return "scale"; }
    std::string_view operator()(const MixTextureDesc&) const { return "mix"; }
    std::string_view operator()(const ThresholdTextureDesc&) const { return "threshold"; }
    std::string_view operator()(const DirectionMixTextureDesc&) const { return "directionmix"; }
    std::string_view operator()(const ImageTextureDesc&) const { return "imagemap"; }
    std::string_view operator()(const CheckerboardTextureDesc&) const { return "checkerboard"; }
    std::string_view operator()(const BilerpTextureDesc&) const { return "bilerp"; }
    std::string_view operator()(const DotsTextureDesc&) const { return "dots"; }
    std::string_view operator()(const FbmTextureDesc&) const { return "fbm"; }
    std::string_view operator()(const WrinkledTextureDesc&) const { return "wrinkled"; }
    std::string_view operator()(const WindyTextureDesc&) const { return "windy"; }
    std::string_view operator()(const MarbleTextureDesc&) const { return "marble"; }
  };
  return std::visit(Name{}, model);
}

bool can_be(const TextureModel& model, bool is_spectrum) {
  return std::visit(
      [&]<class T>(const T&) {
        constexpr bool is_noise = std::is_same_v<T, FbmTextureDesc> || std::is_same_v<T, WrinkledTextureDesc> ||
                                  std::is_same_v<T, WindyTextureDesc>;
        if constexpr (is_noise || std::is_same_v<T, ThresholdTextureDesc>) return !is_spectrum;
        return !std::is_same_v<T, MarbleTextureDesc> || is_spectrum;
      },
      model);
}

const Models<TextureDesc>& texture_models() {
  static const Models<S> models({constant(), scale(), mix(), threshold(), direction_mix(), image(), checkerboard(),
                                 bilerp(), dots(), ptex(), noise<FbmTextureDesc>("fractional Brownian motion"),
                                 noise<WrinkledTextureDesc>("sums of absolute values of noise"),
                                 model("waves of varying height", WindyTextureDesc{}, {}), marble()});
  return models;
}

}  // namespace montelux
