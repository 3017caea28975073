// From what is stated of one material to its row, slot by slot: constants are set once, the rest is bound to textures.
#pragma once
#include <string>

#include "material/build.h"

namespace montelux {

class RowBuilder {
 public:
  // All must outlive the builder.
  RowBuilder(const MaterialInputs& inputs, const SourceLocation& where, Material& material)
      : inputs_(inputs), where_(where), material_(material) {}

  Material& material() { return material_; }

  void put(int slot, float value) { material_.row.v[slot] = value; }
  void put(int slot, const Rgb& value);
  void number(int slot, const NumberInput& input, RowEncoding encoding = RowEncoding::plain);
  // A reflectance or another factor from 0 to 1, and a factor that may exceed 1.
  void spectrum(int slot, const SpectrumInput& input, float scale = 1);
  void unbounded(int slot, const SpectrumInput& input);
  // A spectrum that is not a reflectance.
  void coefficients(int slot, const SpectrumValue& value) { put(slot, inputs_.unbounded(value)); }
  // A spectrum is reduced to one number.
  float index(const IndexInput& eta) const;
  // GGX's alpha along u and v, in two slots.
  void roughness(int slot, const FacetsDesc& facets, bool maps_roughness);
  // eta and k, or a reflectance instead, relative to an outer index.
  void metal(int eta_slot, int k_slot, const MetalDesc& metal, float outer_index);
  // The slots of LayeredSlots.
  void coat(const IndexInput& eta, const FacetsDesc& facets, bool maps_roughness, const LayerDesc& layer);
  // The map of the coat's normals, if there is one.
  void coat_normals(const NormalMapDesc& normals);
  // What is known of a coat of this index and this thickness is looked up by the texture of its roughness.
  void coat_of_texture(float eta, float thickness) { material_.coat = inputs_.coats.of(eta, thickness); }
  // The address of the table of a file. A file that cannot be read has been reported.
  void table(int slot, const std::string& file);

  // Something is wrong; the material is black or has defaults.
  void error(std::string message) { inputs_.diagnostics.error(where_, std::move(message)); }

 private:
  void bind_spectrum(int slot, const SpectrumInput& input, RowEncoding encoding, float scale);
  // Sets a constant, or leaves the slot to be looked up at each point.
  void bind(const RowBinding& binding);

  const MaterialInputs& inputs_;
  const SourceLocation& where_;
  Material& material_;
};

}  // namespace montelux
