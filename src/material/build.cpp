#include "material/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "material/internal_reflectance.h"

namespace montelux {

namespace {

template <class F>
F encoded(F x, const RowBinding& binding) {
  switch (binding.encoding) {
    case RowEncoding::plain:
      break;
    case RowEncoding::unit:
      return clamp(x * binding.scale, 0.0f, 1.0f);
    case RowEncoding::signed_unit:
      x = 2.0f * x - 1.0f;
      break;
    case RowEncoding::roughness:
      x = safe_sqrt(x);
      break;
    case RowEncoding::reflectance_to_k: {
      F r = clamp(x, 0.0f, 0.9999f);
      x = 2.0f * sqrt(r / (1.0f - r));
    }
  }
  return x * binding.scale;
}

// Fills the row of one material, slot by slot.
class RowBuilder {
 public:
  RowBuilder(const Entity& entity, const MaterialInputs& inputs) : entity_(entity), inputs_(inputs) {}

  Material take() && { return std::move(material_); }
  Material& material() { return material_; }

  void put(int slot, float value) { material_.row.v[slot] = value; }
  void put(int slot, const Rgb& value) {
    const Spectrum<float> carried = from_rgb(value);
    for (int i = 0; i < spectrum_size; ++i) put(slot + i, carried.c[i]);
  }
  void number(int slot, std::string_view name, float otherwise, RowEncoding encoding = RowEncoding::plain) {
    bind({std::uint8_t(slot), encoding, false, std::uint32_t(inputs_.textures.number(entity_, name, otherwise)), 1});
  }
  void spectrum(int slot, std::string_view name, Rgb otherwise, float scale = 1) {
    bind({std::uint8_t(slot), RowEncoding::unit, true,
          std::uint32_t(inputs_.textures.spectrum(entity_, name, otherwise)), scale});
  }

  // A spectrum that is not a reflectance, stated directly; default 0.
  void coefficients(int slot, std::string_view name) {
    const auto stated = entity_.parameters.spectrum(name);
    put(slot, stated ? inputs_.unbounded(*stated) : gray_rgb(0.0f));
  }

  // A factor that may exceed one.
  void unbounded(int slot, std::string_view name, Rgb otherwise) {
    bind({std::uint8_t(slot), RowEncoding::plain, true,
          std::uint32_t(inputs_.textures.spectrum(entity_, name, otherwise)), 1});
  }

  // Both slots from "u" + name and "v" + name, or name for both; `prefix` as in "interface.".
  void roughness(int slot, const std::string& prefix) {
    RowEncoding encoding =
        entity_.parameters.boolean("remaproughness", true) ? RowEncoding::roughness : RowEncoding::plain;
    const char* axes[2] = {"uroughness", "vroughness"};
    for (int axis = 0; axis < 2; ++axis) {
      std::string own = prefix + axes[axis];
      number(slot + axis, entity_.parameters.find(own) ? own : prefix + "roughness", 0, encoding);
    }
  }

  // An index of refraction: a number, or a spectrum that is reduced to one number.
  float index(std::string_view name, float otherwise) const {
    if (auto spectrum = entity_.parameters.spectrum(name)) return inputs_.index(*spectrum);
    return entity_.parameters.number(name, otherwise);
  }

  // eta and k, or a reflectance instead, relative to an outer index.
  void metal(int eta_slot, int k_slot, const std::string& prefix, float outer_index) {
    const float scale = 1 / outer_index;
    if (entity_.parameters.find("reflectance")) {
      put(eta_slot, gray_rgb(scale));
      bind({std::uint8_t(k_slot), RowEncoding::reflectance_to_k, true,
            std::uint32_t(inputs_.textures.spectrum(entity_, "reflectance", gray_rgb(0.5f))), scale});
      return;
    }
    const std::string eta_name = prefix + "eta", k_name = prefix + "k";
    SpectrumValue eta = entity_.parameters.spectrum(eta_name).value_or(NamedSpectrum{"metal-Cu-eta"});
    SpectrumValue k = entity_.parameters.spectrum(k_name).value_or(NamedSpectrum{"metal-Cu-k"});
    ConductorRgb rgb = inputs_.conductor(eta, k);
    put(eta_slot, rgb.eta * scale);
    put(k_slot, rgb.k * scale);
    texture_instead(eta_slot, eta_name, scale);
    texture_instead(k_slot, k_name, scale);
  }

 private:
  // A texture instead of a spectrum that is not a reflectance.
  void texture_instead(int slot, const std::string& name, float scale) {
    if (!entity_.parameters.texture(name)) return;
    bind({std::uint8_t(slot), RowEncoding::plain, true,
          std::uint32_t(inputs_.textures.spectrum(entity_, name, gray_rgb(1.0f))), scale});
  }
  // Sets a constant, or leaves the slot to be looked up at each point.
  void bind(const RowBinding& binding) {
    const TextureSet& set = inputs_.textures.textures();
    if (binding.is_spectrum) {
      if (auto constant = set.constant(SpectrumTextureId(binding.texture))) {
        put(binding.slot, per_component([&](float x) { return encoded(x, binding); }, *constant));
        return;
      }
    } else if (auto constant = set.constant(NumberTextureId(binding.texture))) {
      put(binding.slot, encoded(*constant, binding));
      return;
    }
    material_.bindings.push_back(binding);
  }

  const Entity& entity_;
  const MaterialInputs& inputs_;
  Material material_;
};

void layers(RowBuilder& b, const Entity& entity, const std::string& prefix) {
  using Slots = LayeredSlots;
  b.put(Slots::eta, b.index(prefix + "eta", 1.5f));
  b.roughness(Slots::alpha_x, prefix);
  b.number(Slots::thickness, "thickness", 0.01f);
  b.number(Slots::g, "g", 0);
  b.spectrum(Slots::albedo, "albedo", gray_rgb(0.0f));
  b.put(Slots::max_depth, float(entity.parameters.integer("maxdepth", 10)));
  b.put(Slots::samples, float(entity.parameters.integer("nsamples", 1)));
}

// If coat and layer are constant and nothing scatters under the coat, its walks can be summed in closed form.
void sum_reflections(Material& material) {
  using Slots = CoatedDiffuseSlots;
  float* v = material.row.v;
  for (const RowBinding& binding : material.bindings)
    if (binding.slot < Slots::max_depth) return;
  if (!is_black(BsdfRows<float>{&material.row}.spectrum(Slots::albedo))) return;
  v[Slots::internal] =
      internal_reflectance({{v[Slots::alpha_x], v[Slots::alpha_y]}, v[Slots::eta], v[Slots::thickness]});
}

void fill_mixture(RowBuilder& b, const Entity& entity, const MaterialInputs& inputs) {
  const auto& names = entity.parameters.array<std::string>("materials");
  if (names.size() != 2) {
    inputs.diagnostics.error(entity.where,
                             fmt::format("a mix takes the names of two materials in \"string materials\"; "
                                         "found {}",
                                         names.size()));
    return;
  }
  Mixture mixture{{0, 0}, inputs.textures.number(entity, "amount", 0.5f)};
  for (std::size_t i = 0; i < 2; ++i) {
    auto child = inputs.material(names[i]);
    if (!child)
      inputs.diagnostics.error(entity.where,
                               fmt::format("the mix names material \"{}\", which is not defined", names[i]));
    mixture.children[i] = child.value_or(0);
  }
  b.material().mixture = mixture;
}

using Fill = void (*)(RowBuilder&, const Entity&);

// How each model's row follows from its parameters.
struct MaterialRow {
  std::string_view name;
  BsdfKind kind;
  Fill fill;
};

void metallic_roughness(RowBuilder& b) {
  using Slots = MetallicRoughnessSlots;
  b.spectrum(Slots::base, "basecolor", gray_rgb(1.0f));
  b.number(Slots::metallic, "metallic", 1, RowEncoding::unit);
  b.number(Slots::roughness, "roughness", 1, RowEncoding::unit);
  b.number(Slots::specular, "specular", 1, RowEncoding::unit);
  b.unbounded(Slots::specular_color, "specularcolor", gray_rgb(1.0f));
  const float eta = b.index("eta", 1.5f), ratio = (eta - 1) / (eta + 1);
  b.put(Slots::reflected, ratio * ratio);
}

void coat_and_grain(RowBuilder& b, const Entity& entity) {
  using Slots = CoatedMetallicRoughnessSlots;
  b.number(Slots::coat, "clearcoat", 1, RowEncoding::unit);
  b.number(Slots::coat_roughness, "clearcoatroughness", 0, RowEncoding::unit);
  b.number(Slots::anisotropy, "anisotropy", 0, RowEncoding::unit);
  // Encoded as an image stores a direction: 1 and 1/2 decode to 1 and 0.
  b.number(Slots::grain_x, "grainx", 1, RowEncoding::signed_unit);
  b.number(Slots::grain_y, "grainy", 0.5f, RowEncoding::signed_unit);
  const float angle = entity.parameters.number("anisotropyrotation", 0) * (pi / 180);
  b.put(Slots::turn_cos, std::cos(angle)), b.put(Slots::turn_sin, std::sin(angle));
  b.put(Slots::side, entity.parameters.boolean("grainmirrored", false) ? -1.0f : 1.0f);
  b.put(Slots::coat_normal + 2, 1);
}

const std::array<MaterialRow, bsdf_kind_count>& material_rows() {
  static const std::array<MaterialRow, bsdf_kind_count> rows{{
      {"diffuse", BsdfKind::diffuse,
       [](RowBuilder& b, const Entity&) { b.spectrum(DiffuseSlots::reflectance, "reflectance", gray_rgb(0.5f)); }},
      {"conductor", BsdfKind::conductor,
       [](RowBuilder& b, const Entity&) {
         b.roughness(ConductorSlots::alpha_x, "");
         b.metal(ConductorSlots::eta, ConductorSlots::k, "", 1);
       }},
      {"dielectric", BsdfKind::dielectric,
       [](RowBuilder& b, const Entity&) {
         b.roughness(DielectricSlots::alpha_x, "");
         b.put(DielectricSlots::eta, b.index("eta", 1.5f));
       }},
      {"coateddiffuse", BsdfKind::coated_diffuse,
       [](RowBuilder& b, const Entity& entity) {
         layers(b, entity, "");
         b.spectrum(CoatedDiffuseSlots::reflectance, "reflectance", gray_rgb(0.5f));
         sum_reflections(b.material());
       }},
      {"coatedconductor", BsdfKind::coated_conductor,
       [](RowBuilder& b, const Entity& entity) {
         layers(b, entity, "interface.");
         b.roughness(CoatedConductorSlots::conductor_alpha_x, "conductor.");
         b.metal(CoatedConductorSlots::conductor_eta, CoatedConductorSlots::conductor_k, "conductor.",
                 b.index("interface.eta", 1.5f));
       }},
      {"diffusetransmission", BsdfKind::diffuse_transmission,
       [](RowBuilder& b, const Entity& entity) {
         const float scale = entity.parameters.number("scale", 1);
         b.spectrum(DiffuseTransmissionSlots::reflectance, "reflectance", gray_rgb(0.25f), scale);
         b.spectrum(DiffuseTransmissionSlots::transmittance, "transmittance", gray_rgb(0.25f), scale);
       }},
      {"thindielectric", BsdfKind::thin_dielectric,
       [](RowBuilder& b, const Entity& entity) {
         b.put(ThinDielectricSlots::eta, b.index("eta", 1.5f));
         b.spectrum(ThinDielectricSlots::tint, "tint", gray_rgb(1.0f));
         const bool remaps = entity.parameters.boolean("remaproughness", true);
         b.number(ThinDielectricSlots::alpha, "roughness", 0, remaps ? RowEncoding::roughness : RowEncoding::plain);
       }},
      {"phong", BsdfKind::phong,
       [](RowBuilder& b, const Entity&) {
         b.spectrum(PhongSlots::diffuse, "kd", gray_rgb(0.5f));
         b.spectrum(PhongSlots::specular, "ks", gray_rgb(0.3f));
         b.number(PhongSlots::exponent, "exponent", 32);
       }},
      {"metallicroughness", BsdfKind::metallic_roughness, [](RowBuilder& b, const Entity&) { metallic_roughness(b); }},
      {"coatedmetallicroughness", BsdfKind::coated_metallic_roughness,
       [](RowBuilder& b, const Entity& entity) { metallic_roughness(b), coat_and_grain(b, entity); }},
      {"tinteddielectric", BsdfKind::tinted_dielectric,
       [](RowBuilder& b, const Entity&) {
         using Slots = TintedDielectricSlots;
         b.roughness(Slots::alpha_x, "");
         b.put(Slots::eta, b.index("eta", 1.5f));
         b.spectrum(Slots::tint, "tint", gray_rgb(1.0f));
         b.coefficients(Slots::absorption, "absorption");
       }},
  }};
  return rows;
}

}  // namespace

Material build_material(const Entity& entity, const MaterialInputs& inputs) {
  RowBuilder b(entity, inputs);
  if (entity.type == "mix") {
    fill_mixture(b, entity, inputs);
    return std::move(b).take();
  }
  if (entity.type == "interface" || entity.type.empty() || entity.type == "none") {
    b.material().is_interface = true;
    return std::move(b).take();
  }
  const auto& rows = material_rows();
  auto row = std::find_if(rows.begin(), rows.end(), [&](const MaterialRow& r) { return r.name == entity.type; });
  if (row == rows.end()) row = rows.begin();  // unknown to Montelux; the reader has reported it
  b.material().kind = row->kind;
  row->fill(b, entity);
  if (entity.parameters.find("normalmap"))
    b.material().normal_map = inputs.textures.image(entity, "normalmap", ColorEncoding{});
  if (entity.parameters.find("normaltexture"))
    b.material().normal_texture = inputs.textures.spectrum(entity, "normaltexture", gray_rgb(0.5f));
  if (const auto& scale = entity.parameters.array<float>("normalscale"); scale.size() == 2)
    b.material().normal_scale = {scale[0], scale[1]};
  if (entity.parameters.find("coatnormaltexture"))
    b.material().coat_normal_texture = inputs.textures.spectrum(entity, "coatnormaltexture", gray_rgb(0.5f));
  if (const auto& scale = entity.parameters.array<float>("coatnormalscale"); scale.size() == 2)
    b.material().coat_normal_scale = {scale[0], scale[1]};
  return std::move(b).take();
}

bool uses_parameters(const Material& material) {
  if (!material.is_plain()) return true;
  // A grain: different roughness along u and v.
  const float* v = material.row.v;
  switch (material.kind) {
    case BsdfKind::conductor:
      return v[ConductorSlots::alpha_x] != v[ConductorSlots::alpha_y];
    case BsdfKind::dielectric:
    case BsdfKind::tinted_dielectric:
      return v[DielectricSlots::alpha_x] != v[DielectricSlots::alpha_y];
    case BsdfKind::coated_metallic_roughness:
      return v[CoatedMetallicRoughnessSlots::anisotropy] != 0;
    case BsdfKind::coated_diffuse:
      return v[LayeredSlots::alpha_x] != v[LayeredSlots::alpha_y];
    case BsdfKind::coated_conductor:
      return v[LayeredSlots::alpha_x] != v[LayeredSlots::alpha_y] ||
             v[CoatedConductorSlots::conductor_alpha_x] != v[CoatedConductorSlots::conductor_alpha_y];
    default:
      return false;
  }
}

template <class F>
void look_up_slots(const Material& material, const TextureSet& textures, const TexturePoints<F>& points, Mask<F> on,
                   BsdfSlots<F>& slots) {
  const auto put = [&](int slot, F value, const RowBinding& binding) {
    slots.v[slot] = select(on, encoded(value, binding), slots.v[slot]);
  };
  for (const RowBinding& binding : material.bindings) {
    if (!binding.is_spectrum) {
      put(binding.slot, textures.number(NumberTextureId(binding.texture), points, on), binding);
      continue;
    }
    const Spectrum<F> value = textures.spectrum(SpectrumTextureId(binding.texture), points, on);
    for (int i = 0; i < spectrum_size; ++i) put(binding.slot + i, value.c[i], binding);
  }
}

BsdfRow material_row(const Material& material, const TextureSet& textures, const TexturePoint& point) {
  BsdfRow row = material.row;
  look_up_slots<float>(material, textures, {point.uv, point.p, point.n}, true, row);
  return row;
}

// The direction that an image stores as a colour, with x and y scaled.
template <class F>
static Vec3<F> normal_of(const RgbOf<F>& c, const Vec2f& scale) {
  return {scale.x * (2.0f * c.c[0] - 1.0f), scale.y * (2.0f * c.c[1] - 1.0f), 2.0f * c.c[2] - 1.0f};
}

template <class F>
Vec3<F> mapped_normal(const Material& material, const TextureSet& textures, const TexturePoints<F>& points,
                      Mask<F> on) {
  const Vec2<F> st{points.uv.x, 1.0f - points.uv.y};
  RgbOf<F> c;
  if (material.normal_texture)
    c = textures.color(*material.normal_texture, points, on);
  else if constexpr (lanes_of<F> == 1)
    c = material.normal_map->bilinear(st, Wrap::repeat);
  else
    c = material.normal_map->bilinear(st, Wrap::repeat, on);
  return normal_of(c, material.normal_scale);
}

template <class F>
Vec3<F> mapped_coat_normal(const Material& material, const TextureSet& textures, const TexturePoints<F>& points,
                           Mask<F> on) {
  return normal_of(textures.color(*material.coat_normal_texture, points, on), material.coat_normal_scale);
}

template void look_up_slots(const Material&, const TextureSet&, const TexturePoints<float>&, bool, BsdfSlots<float>&);
template void look_up_slots(const Material&, const TextureSet&, const TexturePoints<NativeFloats>&, Mask<NativeFloats>,
                            BsdfSlots<NativeFloats>&);
template Vec3f mapped_normal(const Material&, const TextureSet&, const TexturePoints<float>&, bool);
template Vec3<NativeFloats> mapped_normal(const Material&, const TextureSet&, const TexturePoints<NativeFloats>&,
                                          Mask<NativeFloats>);
template Vec3f mapped_coat_normal(const Material&, const TextureSet&, const TexturePoints<float>&, bool);
template Vec3<NativeFloats> mapped_coat_normal(const Material&, const TextureSet&, const TexturePoints<NativeFloats>&,
                                               Mask<NativeFloats>);

}  // namespace montelux
