#include "material/build.h"

#include <fmt/format.h>

#include <cmath>

#include "material/internal_reflectance.h"

namespace montelux {

namespace {

// Fills the row of one material, slot by slot.
class RowBuilder {
 public:
  explicit RowBuilder(const MaterialInputs& inputs) : inputs_(inputs) {}

  Material take() && { return std::move(material_); }
  Material& material() { return material_; }

  void put(int slot, float value) { material_.row.v[slot] = value; }
  void put(int slot, const Rgb& value) {
    const Spectrum<float> carried = from_rgb(value);
    for (int i = 0; i < spectrum_size; ++i) put(slot + i, carried.c[i]);
  }
  void number(int slot, const NumberInput& input, RowEncoding encoding = RowEncoding::plain) {
    bind({std::uint8_t(slot), encoding, false, std::uint32_t(inputs_.textures.number(input)), 1});
  }
  void spectrum(int slot, const SpectrumInput& input, float scale = 1) {
    bind_spectrum(slot, input, RowEncoding::unit, scale);
  }
  // A factor that may exceed one.
  void unbounded(int slot, const SpectrumInput& input) { bind_spectrum(slot, input, RowEncoding::plain, 1); }
  // A spectrum that is not a reflectance.
  void coefficients(int slot, const SpectrumValue& value) { put(slot, inputs_.unbounded(value)); }

  // GGX's alpha along u and v, in two slots.
  void roughness(int slot, const FacetsDesc& facets, bool maps_roughness) {
    const RowEncoding encoding = maps_roughness ? RowEncoding::roughness : RowEncoding::plain;
    number(slot, facets.roughness_u.value_or(facets.roughness), encoding);
    number(slot + 1, facets.roughness_v.value_or(facets.roughness), encoding);
  }

  // A spectrum is reduced to one number.
  float index(const IndexInput& eta) const {
    if (const auto* spectrum = eta.get<SpectrumValue>()) return inputs_.index(*spectrum);
    return std::get<float>(eta.value);
  }

  // eta and k, or a reflectance instead, relative to an outer index.
  void metal(int eta_slot, int k_slot, const MetalDesc& metal, float outer_index) {
    const float scale = 1 / outer_index;
    if (metal.reflectance) {
      put(eta_slot, gray_rgb(scale));
      bind_spectrum(k_slot, *metal.reflectance, RowEncoding::reflectance_to_k, scale);
      return;
    }
    // One that is a texture counts as the default in the conversion of the other.
    const auto value = [](const SpectrumInput& stated, const SpectrumInput& otherwise) {
      const auto* spectrum = stated.get<SpectrumValue>();
      return spectrum ? *spectrum : std::get<SpectrumValue>(otherwise.value);
    };
    const MetalDesc usual;
    const ConductorRgb rgb = inputs_.conductor(value(metal.eta, usual.eta), value(metal.k, usual.k));
    put(eta_slot, rgb.eta * scale);
    put(k_slot, rgb.k * scale);
    if (metal.eta.get<TextureName>()) bind_spectrum(eta_slot, metal.eta, RowEncoding::plain, scale);
    if (metal.k.get<TextureName>()) bind_spectrum(k_slot, metal.k, RowEncoding::plain, scale);
  }

 private:
  void bind_spectrum(int slot, const SpectrumInput& input, RowEncoding encoding, float scale) {
    bind({std::uint8_t(slot), encoding, true, std::uint32_t(inputs_.textures.spectrum(input)), scale});
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

  const MaterialInputs& inputs_;
  Material material_;
};

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

void put_layer(RowBuilder& b, const IndexInput& eta, const FacetsDesc& facets, bool maps_roughness,
               const LayerDesc& layer) {
  using Slots = LayeredSlots;
  b.put(Slots::eta, b.index(eta));
  b.roughness(Slots::alpha_x, facets, maps_roughness);
  b.number(Slots::thickness, layer.thickness);
  b.number(Slots::g, layer.g);
  b.spectrum(Slots::albedo, layer.albedo);
  b.put(Slots::max_depth, float(layer.max_depth));
  b.put(Slots::samples, float(layer.samples));
}

void put_metallic_roughness(RowBuilder& b, const MetallicRoughnessDesc& m) {
  using Slots = MetallicRoughnessSlots;
  b.spectrum(Slots::base, m.base_color);
  b.number(Slots::metallic, m.metallic, RowEncoding::unit);
  b.number(Slots::roughness, m.roughness, RowEncoding::unit);
  b.number(Slots::specular, m.specular, RowEncoding::unit);
  b.unbounded(Slots::specular_color, m.specular_color);
  const float eta = b.index(m.eta), ratio = (eta - 1) / (eta + 1);
  b.put(Slots::reflected, ratio * ratio);
}

// How the row of each model follows from what is stated.
class ModelBuilder {
 public:
  ModelBuilder(RowBuilder& b, const SourceLocation& where, const MaterialInputs& inputs)
      : b_(b), where_(where), inputs_(inputs) {}

  void operator()(const DiffuseDesc& m) {
    b_.material().kind = BsdfKind::diffuse;
    b_.spectrum(DiffuseSlots::reflectance, m.albedo);
  }
  void operator()(const ConductorDesc& m) {
    b_.material().kind = BsdfKind::conductor;
    b_.roughness(ConductorSlots::alpha_x, m.facets, m.maps_roughness);
    b_.metal(ConductorSlots::eta, ConductorSlots::k, m.metal, 1);
  }
  void operator()(const DielectricDesc& m) {
    b_.material().kind = BsdfKind::dielectric;
    b_.roughness(DielectricSlots::alpha_x, m.facets, m.maps_roughness);
    b_.put(DielectricSlots::eta, b_.index(m.eta));
  }
  void operator()(const TintedDielectricDesc& m) {
    using Slots = TintedDielectricSlots;
    b_.material().kind = BsdfKind::tinted_dielectric;
    b_.roughness(Slots::alpha_x, m.facets, m.maps_roughness);
    b_.put(Slots::eta, b_.index(m.eta));
    b_.spectrum(Slots::tint, m.tint);
    b_.coefficients(Slots::absorption, m.absorption);
  }
  void operator()(const ThinDielectricDesc& m) {
    using Slots = ThinDielectricSlots;
    b_.material().kind = BsdfKind::thin_dielectric;
    b_.put(Slots::eta, b_.index(m.eta));
    b_.spectrum(Slots::tint, m.tint);
    b_.number(Slots::alpha, m.roughness, m.maps_roughness ? RowEncoding::roughness : RowEncoding::plain);
  }
  void operator()(const CoatedDiffuseDesc& m) {
    b_.material().kind = BsdfKind::coated_diffuse;
    put_layer(b_, m.eta, m.facets, m.maps_roughness, m.layer);
    b_.spectrum(CoatedDiffuseSlots::reflectance, m.albedo);
    sum_reflections(b_.material());
  }
  void operator()(const CoatedConductorDesc& m) {
    using Slots = CoatedConductorSlots;
    b_.material().kind = BsdfKind::coated_conductor;
    put_layer(b_, m.coat_eta, m.coat_facets, m.maps_roughness, m.layer);
    b_.roughness(Slots::conductor_alpha_x, m.metal_facets, m.maps_roughness);
    b_.metal(Slots::conductor_eta, Slots::conductor_k, m.metal, b_.index(m.coat_eta));
  }
  void operator()(const DiffuseTransmissionDesc& m) {
    using Slots = DiffuseTransmissionSlots;
    b_.material().kind = BsdfKind::diffuse_transmission;
    b_.spectrum(Slots::reflectance, m.reflected, m.scale);
    b_.spectrum(Slots::transmittance, m.transmitted, m.scale);
  }
  void operator()(const PhongDesc& m) {
    b_.material().kind = BsdfKind::phong;
    b_.spectrum(PhongSlots::diffuse, m.diffuse_albedo);
    b_.spectrum(PhongSlots::specular, m.glossy_albedo);
    b_.number(PhongSlots::exponent, m.exponent);
  }
  void operator()(const MetallicRoughnessDesc& m) {
    b_.material().kind = BsdfKind::metallic_roughness;
    put_metallic_roughness(b_, m);
  }
  void operator()(const CoatedMetallicRoughnessDesc& m) {
    using Slots = CoatedMetallicRoughnessSlots;
    b_.material().kind = BsdfKind::coated_metallic_roughness;
    put_metallic_roughness(b_, m.base);
    b_.number(Slots::coat, m.coat, RowEncoding::unit);
    b_.number(Slots::coat_roughness, m.coat_roughness, RowEncoding::unit);
    b_.number(Slots::anisotropy, m.anisotropy, RowEncoding::unit);
    // Encoded as an image stores a direction: 1 and 1/2 decode to 1 and 0.
    b_.number(Slots::grain_x, m.grain_x, RowEncoding::signed_unit);
    b_.number(Slots::grain_y, m.grain_y, RowEncoding::signed_unit);
    const float angle = m.grain_rotation * (pi / 180);
    b_.put(Slots::turn_cos, std::cos(angle)), b_.put(Slots::turn_sin, std::sin(angle));
    b_.put(Slots::side, m.grain_is_mirrored ? -1.0f : 1.0f);
    b_.put(Slots::coat_normal + 2, 1);
    if (m.coat_normals.texture) b_.material().coat_normal_texture = inputs_.textures.spectrum(*m.coat_normals.texture);
    b_.material().coat_normal_scale = {m.coat_normals.scale[0], m.coat_normals.scale[1]};
  }
  void operator()(const MeasuredDesc& m) {
    Material& material = b_.material();
    material.kind = BsdfKind::measured;
    if (m.file.empty()) {
      inputs_.diagnostics.error(where_, "a measured material needs the file of its table");
      return;
    }
    material.table = inputs_.measured(m.file, where_);
    put_address(material.table.get(), material.row.v + MeasuredSlots::table);
  }
  void operator()(const InterfaceDesc&) { b_.material().is_interface = true; }
  void operator()(const MixDesc& m) {
    if (m.materials.size() != 2) {
      inputs_.diagnostics.error(where_,
                                fmt::format("a mix takes the names of two materials; found {}", m.materials.size()));
      return;
    }
    Mixture mixture{{0, 0}, inputs_.textures.number(m.amount)};
    for (std::size_t i = 0; i < 2; ++i) {
      auto child = inputs_.material(m.materials[i]);
      if (!child)
        inputs_.diagnostics.error(where_,
                                  fmt::format("the mix names material \"{}\", which is not defined", m.materials[i]));
      mixture.children[i] = child.value_or(0);
    }
    b_.material().mixture = mixture;
  }

 private:
  RowBuilder& b_;
  const SourceLocation& where_;
  const MaterialInputs& inputs_;
};

}  // namespace

Material build_material(const MaterialDesc& desc, const MaterialInputs& inputs) {
  RowBuilder b(inputs);
  std::visit(ModelBuilder(b, desc.where, inputs), desc.model);
  Material& material = b.material();
  if (material.mixture || material.is_interface) return std::move(b).take();
  if (!desc.normal_file.empty())
    material.normal_map = inputs.textures.image(desc.normal_file, desc.where, ColorEncoding{});
  if (desc.normals.texture) material.normal_texture = inputs.textures.spectrum(*desc.normals.texture);
  material.normal_scale = {desc.normals.scale[0], desc.normals.scale[1]};
  return std::move(b).take();
}

}  // namespace montelux
