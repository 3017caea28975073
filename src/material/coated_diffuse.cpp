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

// If the layer is constant and nothing scatters under the coat, its walks can be summed in closed form: with what is
// known of a constant roughness, or of the one that a texture has at a point, the same in both directions.
void sum_reflections(RowBuilder& row) {
  using Slots = CoatedDiffuseSlots;
  Material& material = row.material();
  float* v = material.row.v;
  const RowBinding *alpha_x = nullptr, *alpha_y = nullptr;
  for (const RowBinding& binding : material.bindings) {
    if (binding.slot >= Slots::max_depth) continue;
    if (binding.slot != Slots::alpha_x && binding.slot != Slots::alpha_y) return;
    (binding.slot == Slots::alpha_x ? alpha_x : alpha_y) = &binding;
  }
  if (!is_black(BsdfRows<float>{&material.row}.spectrum(Slots::albedo))) return;
  if (alpha_x || alpha_y) {
    if (alpha_x && alpha_y && alpha_x->texture == alpha_y->texture)
      row.coat_of_texture(v[Slots::eta], v[Slots::thickness]);
    return;
  }
  const CoatParameters coat{{v[Slots::alpha_x], v[Slots::alpha_y]}, v[Slots::eta], v[Slots::thickness]};
  v[Slots::internal] = internal_reflectance(coat);
  std::ranges::copy(coat_transmittance::series(coat), v + Slots::series);
}

}  // namespace

void CoatedDiffuseDesc::fill(RowBuilder& row) const {
  row.coat(eta, facets, maps_roughness, layer);
  row.spectrum(CoatedDiffuseSlots::reflectance, albedo);
  sum_reflections(row);
}

}  // namespace montelux
