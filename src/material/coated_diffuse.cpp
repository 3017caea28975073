#include "material/coated_diffuse.h"

#include <algorithm>

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<CoatedDiffuseDesc> CoatedDiffuseDesc::rows() {
  using M = CoatedDiffuseDesc;
  Fields<M> fields;
  montelux::albedo(fields, "reflectance", &M::albedo, "albedo of the base");
  index(fields, &M::eta, "index of refraction of the coat");
  fields.part(&M::facets, rows_of_facets());
  remap(fields, &M::maps_roughness);
  fields.part(&M::layer, rows_of_layer());
  return fields;
}

namespace {

// If coat and layer are constant and nothing scatters under the coat, its walks can be summed in closed form.
void sum_reflections(Material& material) {
  using Slots = CoatedDiffuseSlots;
  float* v = material.row.v;
  for (const RowBinding& binding : material.bindings)
    if (binding.slot < Slots::max_depth) return;
  if (!is_black(BsdfRows<float>{&material.row}.spectrum(Slots::albedo))) return;
  const CoatParameters coat{{v[Slots::alpha_x], v[Slots::alpha_y]}, v[Slots::eta], v[Slots::thickness]};
  v[Slots::internal] = internal_reflectance(coat);
  std::ranges::copy(coat_transmittance::series(coat), v + Slots::series);
}

}  // namespace

void CoatedDiffuseDesc::fill(RowBuilder& row) const {
  row.coat(eta, facets, maps_roughness, layer);
  row.spectrum(CoatedDiffuseSlots::reflectance, albedo);
  sum_reflections(row.material());
}

}  // namespace montelux
