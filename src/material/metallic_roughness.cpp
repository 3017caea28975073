#include "material/metallic_roughness.h"

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<MetallicRoughnessDesc> MetallicRoughnessDesc::rows() {
  using M = MetallicRoughnessDesc;
  Fields<M> fields;
  albedo(fields, "basecolor", &M::base_color, "albedo of the diffuse part, and colour of the metal");
  fields.input<NumberInput>("metallic", &M::metallic, "share of the metal", 0, 1);
  fields.input<NumberInput>("roughness", &M::roughness, "alpha of the facets is its square", 0, 1);
  fields.input<NumberInput>("specular", &M::specular, "strength of the dielectric's reflection", 0, 1);
  fields.input<SpectrumInput>("specularcolor", &M::specular_color, "its colour at normal incidence", 0, no_upper_bound);
  index(fields, &M::eta, "index of refraction of the dielectric", "eta", 1);
  return fields;
}

void MetallicRoughnessDesc::fill(RowBuilder& row) const {
  using Slots = MetallicRoughnessSlots;
  row.spectrum(Slots::base, base_color);
  row.number(Slots::metallic, metallic, RowEncoding::unit);
  row.number(Slots::roughness, roughness, RowEncoding::unit);
  row.number(Slots::specular, specular, RowEncoding::unit);
  row.unbounded(Slots::specular_color, specular_color);
  const float index = row.index(eta), ratio = (index - 1) / (index + 1);
  row.put(Slots::reflected, ratio * ratio);
}

}  // namespace montelux
