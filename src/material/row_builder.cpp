#include "material/row_builder.h"

#include "material/layered.h"

namespace montelux {

void RowBuilder::put(int slot, const Rgb& value) {
  const Spectrum<float> carried = from_rgb(value);
  for (int i = 0; i < spectrum_size; ++i) put(slot + i, carried.c[i]);
}

void RowBuilder::number(int slot, const NumberInput& input, RowEncoding encoding) {
  bind({std::uint8_t(slot), encoding, false, std::uint32_t(inputs_.textures.number(input)), 1});
}

void RowBuilder::spectrum(int slot, const SpectrumInput& input, float scale) {
  bind_spectrum(slot, input, RowEncoding::unit, scale);
}

void RowBuilder::unbounded(int slot, const SpectrumInput& input) { bind_spectrum(slot, input, RowEncoding::plain, 1); }

float RowBuilder::index(const IndexInput& eta) const {
  if (const auto* spectrum = eta.get<SpectrumValue>()) return inputs_.index(*spectrum);
  return std::get<float>(eta.value);
}

void RowBuilder::roughness(int slot, const FacetsDesc& facets, bool maps_roughness) {
  const RowEncoding encoding = maps_roughness ? RowEncoding::roughness : RowEncoding::plain;
  number(slot, facets.roughness_u.value_or(facets.roughness), encoding);
  number(slot + 1, facets.roughness_v.value_or(facets.roughness), encoding);
}

void RowBuilder::metal(int eta_slot, int k_slot, const MetalDesc& metal, float outer_index) {
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

void RowBuilder::coat(const IndexInput& eta, const FacetsDesc& facets, bool maps_roughness, const LayerDesc& layer) {
  using Slots = LayeredSlots;
  put(Slots::eta, index(eta));
  roughness(Slots::alpha_x, facets, maps_roughness);
  number(Slots::thickness, layer.thickness);
  number(Slots::g, layer.g);
  spectrum(Slots::albedo, layer.albedo);
  put(Slots::max_depth, float(layer.max_depth));
  put(Slots::samples, float(layer.samples));
}

void RowBuilder::coat_normals(const NormalMapDesc& normals) {
  if (normals.texture) material_.coat_normal_texture = inputs_.textures.spectrum(*normals.texture);
  material_.coat_normal_scale = {normals.scale[0], normals.scale[1]};
}

void RowBuilder::table(int slot, const std::string& file) {
  material_.table = inputs_.measured(file, where_);
  put_address(material_.table.get(), material_.row.v + slot);
}

void RowBuilder::bind_spectrum(int slot, const SpectrumInput& input, RowEncoding encoding, float scale) {
  bind({std::uint8_t(slot), encoding, true, std::uint32_t(inputs_.textures.spectrum(input)), scale});
}

void RowBuilder::bind(const RowBinding& binding) {
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

}  // namespace montelux
