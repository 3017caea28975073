#include "io/gltf/materials.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace montelux::gltf {

namespace {

Rgb rgb_of(const std::vector<double>& v) { return Rgb{{float(v[0]), float(v[1]), float(v[2])}}; }

bool is_black(const Rgb& c) { return c[0] <= 0 && c[1] <= 0 && c[2] <= 0; }

// Reflectances and similar factors are between 0 and 1.
std::vector<double> shares(const Element& element, std::vector<double> otherwise) {
  auto list = element.numbers(otherwise.size());
  if (!list) return otherwise;
  for (double& x : *list)
    if (!(x >= 0 && x <= 1)) {
      element.error("each number must be from 0 to 1");
      return otherwise;
    }
  return *list;
}

bool is_double_sided(const Element& material) { return material["doubleSided"].boolean().value_or(false); }

double share(const Element& element, double otherwise) { return element.number(0, 1).value_or(otherwise); }

}  // namespace

void MaterialReader::note_uv_set(const std::optional<TextureUse>& use, const Element& material) {
  if (!use) return;
  if (!uv_set_) uv_set_ = use->uv_set;
  if (*uv_set_ != use->uv_set)
    material.warning("textures use different sets of texture coordinates: set " + std::to_string(*uv_set_) +
                     " is used for all");
}

SpectrumInput MaterialReader::spectrum(const Factor& factor, TexelMeaning meaning) {
  if (factor.texture)
    return {TextureName{textures_.spectrum(*factor.texture, factor.value, meaning)}, factor.texture->where};
  return RgbValue{factor.value};
}

NumberInput MaterialReader::channel(const Factor& factor, ImageChannel channel) {
  const float value = factor.value[0];
  if (factor.texture && value != 0)
    return {TextureName{textures_.number(*factor.texture, channel, double(value))}, factor.texture->where};
  return value;
}

MaterialReader::Factor MaterialReader::base_color(const Element& material) {
  const Element model = material["pbrMetallicRoughness"];
  Factor factor{rgb_of(shares(model["baseColorFactor"], {1, 1, 1, 1})), textures_.use(model["baseColorTexture"])};
  note_uv_set(factor.texture, material);
  return factor;
}

double MaterialReader::base_alpha(const Element& material) const {
  return shares(material["pbrMetallicRoughness"]["baseColorFactor"], {1, 1, 1, 1})[3];
}

// KHR_materials_ior and KHR_materials_specular.
void MaterialReader::read_specular(const Element& extensions, MetallicRoughnessDesc& base) {
  const Element ior = extensions["KHR_materials_ior"]["ior"];
  if (const auto eta = ior.number()) {
    if (*eta != 0 && *eta < 1)
      ior.error("an index of refraction must be at least 1");
    else
      // 0 means that the dielectric reflects like a mirror, as with an infinite index.
      base.eta = float(*eta == 0 ? 1e6 : *eta);
  }
  const Element specular = extensions["KHR_materials_specular"];
  if (!specular) return;
  Factor weight{gray_rgb(float(share(specular["specularFactor"], 1))), textures_.use(specular["specularTexture"])};
  note_uv_set(weight.texture, specular);
  base.specular = channel(weight, ImageChannel::a);
  Factor color{gray_rgb(1.0f), textures_.use(specular["specularColorTexture"])};
  note_uv_set(color.texture, specular);
  if (const auto stated = specular["specularColorFactor"].numbers(3)) {
    if (std::any_of(stated->begin(), stated->end(), [](double x) { return x < 0; }))
      specular["specularColorFactor"].error("must not be negative");
    else
      color.value = rgb_of(*stated);
  }
  base.specular_color = spectrum(color, TexelMeaning::color);
}

// KHR_materials_clearcoat and KHR_materials_anisotropy.
MaterialModel MaterialReader::with_coat_and_grain(const MetallicRoughnessDesc& base, const Element& extensions) {
  const Element coat = extensions["KHR_materials_clearcoat"], grain = extensions["KHR_materials_anisotropy"];
  const Factor amount{gray_rgb(float(share(coat["clearcoatFactor"], 0))), textures_.use(coat["clearcoatTexture"])};
  const Factor strength{gray_rgb(float(share(grain["anisotropyStrength"], 0))),
                        textures_.use(grain["anisotropyTexture"])};
  const Factor roughness{gray_rgb(float(share(coat["clearcoatRoughnessFactor"], 0))),
                         textures_.use(coat["clearcoatRoughnessTexture"])};
  if (is_black(amount.value) && is_black(strength.value)) return base;
  for (const Factor* factor : {&amount, &roughness, &strength}) note_uv_set(factor->texture, coat ? coat : grain);
  CoatedMetallicRoughnessDesc coated{base};
  coated.coat = channel(amount, ImageChannel::r);
  coated.coat_roughness = channel(roughness, ImageChannel::g);
  if (!is_black(amount.value)) coated.coat_normals = normal_map(coat["clearcoatNormalTexture"]);
  if (is_black(strength.value)) return coated;
  coated.anisotropy = channel(strength, ImageChannel::b);
  coated.grain_rotation = float(grain["anisotropyRotation"].number().value_or(0) * 180 / std::numbers::pi);
  if (!strength.texture) return coated;
  const Factor direction{gray_rgb(1.0f), strength.texture};
  coated.grain_x = channel(direction, ImageChannel::r);
  coated.grain_y = channel(direction, ImageChannel::g);
  return coated;
}

// KHR_materials_volume: attenuationColor is the transmittance of attenuationDistance.
SpectrumValue MaterialReader::absorption(const Element& volume) {
  const SpectrumValue none = TintedDielectricDesc().absorption;
  const std::vector<double> left = shares(volume["attenuationColor"], {1, 1, 1});
  const Element stated = volume["attenuationDistance"];
  const auto distance = stated.number();
  if (!distance) return none;
  if (!(*distance > 0)) {
    stated.error("must be above 0");
    return none;
  }
  Rgb absorption;
  // A black component absorbs everything over that distance, but not immediately.
  for (int i = 0; i < rgb_size; ++i)
    absorption.c[i] = float(-std::log(std::max(left[std::size_t(i)], 1e-6)) / *distance);
  return is_black(absorption) ? none : RgbValue{absorption};
}

NormalMapDesc MaterialReader::normal_map(const Element& info) {
  const auto use = textures_.use(info);
  if (!use) return {};
  note_uv_set(use, info);
  NormalMapDesc map;
  map.texture.emplace(TextureName{textures_.spectrum(*use, gray_rgb(1.0f), TexelMeaning::data)}, use->where);
  const float scale = float(info["scale"].number().value_or(1));
  map.scale = {scale, scale};
  return map;
}

// The material for mirrored texture coordinates; nothing if it is the same.
std::optional<MaterialDesc> MaterialReader::mirrored(const MaterialDesc& material) {
  MaterialDesc turned = material;
  bool differs = false;
  const auto turn = [&](NormalMapDesc& map) {
    if (!map.texture) return;
    map.scale[1] = -map.scale[1];
    differs = true;
  };
  turn(turned.normals);
  if (auto* coated = std::get_if<CoatedMetallicRoughnessDesc>(&turned.model)) {
    turn(coated->coat_normals);
    coated->grain_is_mirrored = coated->anisotropy != CoatedMetallicRoughnessDesc().anisotropy;
    differs = differs || coated->grain_is_mirrored;
  }
  return differs ? std::optional(std::move(turned)) : std::nullopt;
}

MaterialDescId MaterialReader::add(MaterialDesc material, const std::string& name) {
  const auto id = MaterialDescId(scene_.materials.size());
  material.name = std::to_string(scene_.materials.size());
  if (!name.empty()) material.name += " " + name;
  scene_.materials.push_back(std::move(material));
  return id;
}

// A body where there is a volume, otherwise a pane.
MaterialModel MaterialReader::glass(const MaterialDesc& base, const Element& material) {
  const Element volume = material["extensions"]["KHR_materials_volume"], model = material["pbrMetallicRoughness"];
  const bool is_solid = volume && volume["thicknessFactor"].number().value_or(0) > 0;
  const double roughness = share(model["roughnessFactor"], 1);
  const auto* coated = std::get_if<CoatedMetallicRoughnessDesc>(&base.model);
  const auto* opaque = coated ? &coated->base : std::get_if<MetallicRoughnessDesc>(&base.model);
  const IndexInput eta = opaque ? opaque->eta : MetallicRoughnessDesc().eta;
  // The facets' alpha is the square.
  NumberInput alpha = float(roughness * roughness);
  const auto roughness_map = textures_.use(model["metallicRoughnessTexture"]);
  if (roughness_map && roughness > 0)
    alpha = {TextureName{textures_.squared(textures_.number(*roughness_map, ImageChannel::g, roughness))},
             roughness_map->where};
  const SpectrumValue absorbed = is_solid ? absorption(volume) : gray_value(0);
  const Factor color = base_color(material);
  const bool is_tinted = color.texture || color.value[0] < 1 || color.value[1] < 1 || color.value[2] < 1;
  const SpectrumInput tint = is_tinted ? spectrum(color, TexelMeaning::color) : ThinDielectricDesc().tint;
  if (is_solid) return TintedDielectricDesc{eta, tint, absorbed, {alpha}, false};
  return ThinDielectricDesc{eta, tint, alpha, false};
}

// KHR_materials_transmission: a share of the light passes, through glass or, if there is no volume, through a pane.
MaterialDescId MaterialReader::transmitting(const MaterialDesc& base, const Element& material,
                                            const std::string& name) {
  const Element transmission = material["extensions"]["KHR_materials_transmission"];
  Factor amount{gray_rgb(float(share(transmission["transmissionFactor"], 0))),
                textures_.use(transmission["transmissionTexture"])};
  note_uv_set(amount.texture, material);
  if (is_black(amount.value)) return add(base, name);
  MaterialDesc pane = base;
  pane.model = glass(base, material);
  // Reported once, for any number of materials.
  if (std::holds_alternative<CoatedMetallicRoughnessDesc>(base.model) && !std::exchange(has_lost_coat_, true))
    transmission.warning(
        "transmissive glass is shown without its clear coat and its grain, here and in all such materials");
  const MaterialDescId through = add(std::move(pane), name.empty() ? "glass" : name + " glass");
  if (!amount.texture && amount.value[0] >= 1) return through;
  const MaterialDescId opaque = add(base, name.empty() ? "opaque" : name + " opaque");
  MaterialDesc mix;
  mix.where = material.where();
  mix.model = MixDesc{{scene_.materials[std::size_t(opaque)].name, scene_.materials[std::size_t(through)].name},
                      channel(amount, ImageChannel::r)};
  return add(std::move(mix), name);
}

bool MaterialReader::repeats(const std::optional<TextureUse>& texture) {
  return texture && (texture->folds[0] != Fold::clamp || texture->folds[1] != Fold::clamp);
}

std::optional<AreaLightDesc> MaterialReader::emission_of(const Factor& factor, double scale, const Element& where) {
  if (is_black(factor.value) || scale <= 0) return std::nullopt;
  AreaLightDesc light;
  light.where = where.where(), light.scale = float(scale);
  const SpectrumValue color = RgbValue{factor.value};
  if (factor.texture) {
    light.tint = color, light.file = factor.texture->file, light.local_power = true;
    if (factor.texture->uv_map != TextureUse().uv_map)
      where.warning("the KHR_texture_transform of an emissive texture is not applied");
  } else {
    light.radiance = color;
  }
  return light;
}

std::optional<AreaLightDesc> MaterialReader::emission(const Element& material) {
  Factor factor{rgb_of(shares(material["emissiveFactor"], {0, 0, 0})), textures_.use(material["emissiveTexture"])};
  const Element strength = material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"];
  const double scale = strength.number(0, 1e30).value_or(1);
  note_uv_set(factor.texture, material);
  std::optional<AreaLightDesc> light = emission_of(factor, scale, material);
  if (light) light->two_sided = is_double_sided(material);
  return light;
}

std::optional<NumberInput> MaterialReader::alpha(const Element& material) {
  const auto mode = material["alphaMode"].choice({"OPAQUE", "MASK", "BLEND"}).value_or("OPAQUE");
  const double cutoff = material["alphaCutoff"].number(0, 1e30).value_or(0.5);
  if (mode == "OPAQUE") return std::nullopt;
  const double factor = base_alpha(material);
  const auto texture = textures_.use(material["pbrMetallicRoughness"]["baseColorTexture"]);
  if (texture && factor > 0) {
    const std::string name = textures_.number(*texture, ImageChannel::a, factor);
    return NumberInput(TextureName{mode == "MASK" ? textures_.threshold(name, cutoff) : name}, material.where());
  }
  return NumberInput(mode == "BLEND" ? float(factor) : factor >= cutoff ? 1.0f : 0.0f);
}

// KHR_materials_unlit: a black surface that emits its base colour, on the sides that are shown.
MaterialUse MaterialReader::read_unlit(const Element& material) {
  MaterialUse use;
  MaterialDesc black;
  black.model = DiffuseDesc{RgbValue{Rgb{}}}, black.where = material.where();
  use.id = add(std::move(black), material["name"].text().value_or(""));
  use.area_light = emission_of(base_color(material), 1, material);
  use.one_sided = !is_double_sided(material);
  if (use.area_light) use.area_light->two_sided = !use.one_sided;
  use.repeats_emission = repeats(base_color(material).texture);
  use.alpha = alpha(material);
  return use;
}

MaterialUse MaterialReader::read(const Element& material) {
  uv_set_.reset();
  const Element extensions = material["extensions"];
  if (extensions["KHR_materials_unlit"]) {
    MaterialUse use = read_unlit(material);
    use.uv_set = uv_set_.value_or(0);
    return use;
  }
  const Element model = material["pbrMetallicRoughness"];
  const std::string name = material["name"].text().value_or("");
  const Factor base = base_color(material);
  Factor metallic{gray_rgb(float(share(model["metallicFactor"], 1))), textures_.use(model["metallicRoughnessTexture"])};
  Factor roughness{gray_rgb(float(share(model["roughnessFactor"], 1))), metallic.texture};
  note_uv_set(metallic.texture, material);

  MetallicRoughnessDesc facets;
  read_specular(extensions, facets);
  MaterialDesc desc;
  desc.where = material.where();
  desc.model = with_coat_and_grain(facets, extensions);
  auto* coated = std::get_if<CoatedMetallicRoughnessDesc>(&desc.model);
  const NumberInput none = 0.0f;
  // Without a specular part it is Lambertian.
  if (!coated && is_black(metallic.value) && facets.specular == none) {
    desc.model = DiffuseDesc{spectrum(base, TexelMeaning::color)};
  } else {
    MetallicRoughnessDesc& opaque = coated ? coated->base : std::get<MetallicRoughnessDesc>(desc.model);
    opaque.base_color = spectrum(base, TexelMeaning::color);
    opaque.metallic = channel(metallic, ImageChannel::b);
    opaque.roughness = channel(roughness, ImageChannel::g);
  }
  desc.normals = normal_map(material["normalTexture"]);
  MaterialUse use;
  use.id = transmitting(desc, material, name);
  if (const std::optional<MaterialDesc> turned = mirrored(desc))
    use.mirrored = transmitting(*turned, material, name.empty() ? "mirrored" : name + " mirrored");
  use.area_light = emission(material);
  use.repeats_emission = use.area_light && repeats(textures_.use(material["emissiveTexture"]));
  use.alpha = alpha(material);
  // Glass has an inside, from which its surface is visible.
  use.one_sided =
      !is_double_sided(material) && scene_.materials[std::size_t(use.id)].model.index() == desc.model.index();
  use.uv_set = uv_set_.value_or(0);
  return use;
}

const MaterialUse& MaterialReader::use(std::optional<std::size_t> number) {
  auto [place, is_new] = uses_.try_emplace(number);
  // An absent element has all defaults.
  if (is_new)
    place->second =
        read(number ? document_.list("materials")[*number] : document_.root()["materials"][std::size_t(-1)]);
  return place->second;
}

}  // namespace montelux::gltf
