#include "io/gltf/materials.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "io/gltf/parameters.h"

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

void MaterialReader::put_spectrum(Entity& e, const char* name, const Factor& factor, TexelMeaning meaning) {
  if (factor.texture)
    put_texture(e, name, textures_.spectrum(*factor.texture, factor.value, meaning));
  else
    put_rgb(e, name, factor.value);
}

void MaterialReader::put_channel(Entity& e, const char* name, const Factor& factor, const char* channel) {
  const double value = double(factor.value[0]);
  if (factor.texture && value != 0)
    put_texture(e, name, textures_.number(*factor.texture, channel, value));
  else
    put_number(e, name, value);
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
void MaterialReader::put_specular(Entity& e, const Element& extensions) {
  const Element ior = extensions["KHR_materials_ior"]["ior"];
  if (const auto eta = ior.number()) {
    if (*eta != 0 && *eta < 1)
      ior.error("an index of refraction must be at least 1");
    else
      // 0 means that the dielectric reflects like a mirror, as with an infinite index.
      put_number(e, "eta", *eta == 0 ? 1e6 : *eta);
  }
  const Element specular = extensions["KHR_materials_specular"];
  if (!specular) return;
  Factor weight{gray_rgb(float(share(specular["specularFactor"], 1))), textures_.use(specular["specularTexture"])};
  note_uv_set(weight.texture, specular);
  put_channel(e, "specular", weight, "a");
  Factor color{gray_rgb(1.0f), textures_.use(specular["specularColorTexture"])};
  note_uv_set(color.texture, specular);
  if (const auto stated = specular["specularColorFactor"].numbers(3)) {
    if (std::any_of(stated->begin(), stated->end(), [](double x) { return x < 0; }))
      specular["specularColorFactor"].error("must not be negative");
    else
      color.value = rgb_of(*stated);
  }
  put_spectrum(e, "specularcolor", color, TexelMeaning::color);
}

// KHR_materials_clearcoat and KHR_materials_anisotropy.
void MaterialReader::put_coat_and_grain(Entity& e, const Element& extensions) {
  const Element coat = extensions["KHR_materials_clearcoat"], grain = extensions["KHR_materials_anisotropy"];
  const Factor amount{gray_rgb(float(share(coat["clearcoatFactor"], 0))), textures_.use(coat["clearcoatTexture"])};
  const Factor strength{gray_rgb(float(share(grain["anisotropyStrength"], 0))),
                        textures_.use(grain["anisotropyTexture"])};
  const Factor roughness{gray_rgb(float(share(coat["clearcoatRoughnessFactor"], 0))),
                         textures_.use(coat["clearcoatRoughnessTexture"])};
  if (is_black(amount.value) && is_black(strength.value)) return;
  for (const Factor* factor : {&amount, &roughness, &strength}) note_uv_set(factor->texture, coat ? coat : grain);
  e.type = "coatedmetallicroughness";
  put_channel(e, "clearcoat", amount, "r");
  put_channel(e, "clearcoatroughness", roughness, "g");
  if (!is_black(amount.value)) put_normal_map(e, coat["clearcoatNormalTexture"], coat_normals);
  if (is_black(strength.value)) return;
  put_channel(e, "anisotropy", strength, "b");
  put_number(e, "anisotropyrotation", grain["anisotropyRotation"].number().value_or(0) * 180 / std::numbers::pi);
  if (!strength.texture) return;
  const Factor direction{gray_rgb(1.0f), strength.texture};
  put_channel(e, "grainx", direction, "r");
  put_channel(e, "grainy", direction, "g");
}

// KHR_materials_volume: attenuationColor is the transmittance of attenuationDistance.
void MaterialReader::put_absorption(Entity& glass, const Element& volume) {
  const std::vector<double> left = shares(volume["attenuationColor"], {1, 1, 1});
  const Element stated = volume["attenuationDistance"];
  const auto distance = stated.number();
  if (!distance) return;
  if (!(*distance > 0)) return stated.error("must be above 0");
  Rgb absorption;
  // A black component absorbs everything over that distance, but not immediately.
  for (int i = 0; i < rgb_size; ++i)
    absorption.c[i] = float(-std::log(std::max(left[std::size_t(i)], 1e-6)) / *distance);
  if (!is_black(absorption)) put_rgb(glass, "absorption", absorption);
}

void MaterialReader::put_normal_map(Entity& e, const Element& info, const NormalParameters& names) {
  const auto use = textures_.use(info);
  if (!use) return;
  note_uv_set(use, info);
  put_texture(e, names.texture, textures_.spectrum(*use, gray_rgb(1.0f), TexelMeaning::data));
  const double scale = info["scale"].number().value_or(1);
  if (scale != 1) put_numbers(e, names.scale, {float(scale), float(scale)});
}

// The material for mirrored texture coordinates; nothing if it is the same.
std::optional<Entity> MaterialReader::mirrored(const Entity& e) {
  const bool has_grain = e.parameters.find("anisotropyrotation") != nullptr;
  Entity turned{e.type, {}, e.where};
  for (const Parameter& p : e.parameters.all())
    if (p.name != base_normals.scale && p.name != coat_normals.scale) turned.parameters.add(p);
  bool has_map = false;
  for (const NormalParameters& names : {base_normals, coat_normals}) {
    if (!e.parameters.find(names.texture)) continue;
    has_map = true;
    const auto& stated = e.parameters.array<float>(names.scale);
    const float scale = stated.empty() ? 1 : stated[0];
    put_numbers(turned, names.scale, {scale, -scale});
  }
  if (!has_map && !has_grain) return std::nullopt;
  if (has_grain) put_boolean(turned, "grainmirrored", true);
  return turned;
}

MaterialDescId MaterialReader::add(Entity e, const std::string& name) {
  const auto id = MaterialDescId(scene_.materials.size());
  std::string unique = std::to_string(scene_.materials.size());
  if (!name.empty()) unique += " " + name;
  scene_.materials.push_back({std::move(unique), std::move(e)});
  return id;
}

// KHR_materials_transmission: a share of the light passes, through glass or, if there is no volume, through a pane.
MaterialDescId MaterialReader::transmitting(const Entity& base, const Element& material, const std::string& name) {
  const Element extensions = material["extensions"], transmission = extensions["KHR_materials_transmission"];
  const Element volume = extensions["KHR_materials_volume"], model = material["pbrMetallicRoughness"];
  Factor amount{gray_rgb(float(share(transmission["transmissionFactor"], 0))),
                textures_.use(transmission["transmissionTexture"])};
  note_uv_set(amount.texture, material);
  if (is_black(amount.value)) return add(base, name);
  const bool is_solid = volume && volume["thicknessFactor"].number().value_or(0) > 0;
  const double roughness = share(model["roughnessFactor"], 1);
  const float eta = base.parameters.number("eta", 1.5f);
  Entity glass{is_solid ? "tinteddielectric" : "thindielectric", {}, material.where()};
  put_number(glass, "eta", double(eta));
  // The facets' alpha is the square.
  const auto roughness_map = textures_.use(model["metallicRoughnessTexture"]);
  if (roughness_map && roughness > 0)
    put_texture(glass, "roughness", textures_.squared(textures_.number(*roughness_map, "g", roughness)));
  else
    put_number(glass, "roughness", roughness * roughness);
  put_boolean(glass, "remaproughness", false);
  if (is_solid) put_absorption(glass, volume);
  const Factor tint = base_color(material);
  if (tint.texture || tint.value[0] < 1 || tint.value[1] < 1 || tint.value[2] < 1)
    put_spectrum(glass, "tint", tint, TexelMeaning::color);
  // Reported once, for any number of materials.
  if (base.type == "coatedmetallicroughness" && !std::exchange(has_lost_coat_, true))
    transmission.warning(
        "transmissive glass is shown without its clear coat and its grain, here and in all such materials");
  for (const char* part : {base_normals.texture, base_normals.scale})
    if (const Parameter* map = base.parameters.find(part)) glass.parameters.add(*map);
  const MaterialDescId through = add(std::move(glass), name.empty() ? "glass" : name + " glass");
  if (!amount.texture && amount.value[0] >= 1) return through;
  const MaterialDescId opaque = add(base, name.empty() ? "opaque" : name + " opaque");
  Entity mix{"mix", {}, material.where()};
  put_strings(mix, "materials",
              {scene_.materials[std::size_t(opaque)].name, scene_.materials[std::size_t(through)].name});
  put_channel(mix, "amount", amount, "r");
  return add(std::move(mix), name);
}

bool MaterialReader::repeats(const std::optional<TextureUse>& texture) {
  return texture && (texture->wrap[0] != "clamp" || texture->wrap[1] != "clamp");
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

std::optional<Parameter> MaterialReader::alpha(const Element& material) {
  const auto mode = material["alphaMode"].choice({"OPAQUE", "MASK", "BLEND"}).value_or("OPAQUE");
  const double cutoff = material["alphaCutoff"].number(0, 1e30).value_or(0.5);
  if (mode == "OPAQUE") return std::nullopt;
  const double factor = base_alpha(material);
  const auto texture = textures_.use(material["pbrMetallicRoughness"]["baseColorTexture"]);
  Entity e{"", {}, material.where()};
  if (texture && factor > 0) {
    std::string name = textures_.number(*texture, "a", factor);
    put_texture(e, "alpha", mode == "MASK" ? textures_.threshold(name, cutoff) : name);
  } else {
    put_number(e, "alpha", mode == "BLEND" ? factor : factor >= cutoff ? 1.0 : 0.0);
  }
  return e.parameters.all().front();
}

// KHR_materials_unlit: a black surface that emits its base colour, on the sides that are shown.
MaterialUse MaterialReader::read_unlit(const Element& material) {
  MaterialUse use;
  Entity black{"diffuse", {}, material.where()};
  put_rgb(black, "reflectance", Rgb{});
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

  Entity e{"metallicroughness", {}, material.where()};
  put_specular(e, extensions);
  put_coat_and_grain(e, extensions);
  const bool is_coated = e.type == "coatedmetallicroughness";
  // Without a specular part it is Lambertian.
  const bool is_diffuse = !is_coated && is_black(metallic.value) && e.parameters.number("specular", 1) == 0;
  if (is_diffuse) e = Entity{"diffuse", {}, material.where()};
  put_spectrum(e, is_diffuse ? "reflectance" : "basecolor", base, TexelMeaning::color);
  if (!is_diffuse) {
    put_channel(e, "metallic", metallic, "b");
    put_channel(e, "roughness", roughness, "g");
  }
  put_normal_map(e, material["normalTexture"], base_normals);
  MaterialUse use;
  use.id = transmitting(e, material, name);
  if (const std::optional<Entity> turned = mirrored(e))
    use.mirrored = transmitting(*turned, material, name.empty() ? "mirrored" : name + " mirrored");
  use.area_light = emission(material);
  use.repeats_emission = use.area_light && repeats(textures_.use(material["emissiveTexture"]));
  use.alpha = alpha(material);
  // Glass has an inside, from which its surface is visible.
  use.one_sided = !is_double_sided(material) && scene_.materials[std::size_t(use.id)].entity.type == e.type;
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
