#include "material/coated_conductor.h"

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<CoatedConductorDesc> CoatedConductorDesc::rows() {
  using M = CoatedConductorDesc;
  Fields<M> fields;
  fields.part(&M::metal, rows_of_metal("conductor.eta", "conductor.k"));
  fields.part(&M::metal_facets,
              rows_of_facets({"conductor.roughness", "conductor.uroughness", "conductor.vroughness"}));
  index(fields, &M::coat_eta, "index of refraction of the coat", "interface.eta");
  fields.part(&M::coat_facets, rows_of_facets({"interface.roughness", "interface.uroughness", "interface.vroughness"}));
  remap(fields, &M::maps_roughness);
  fields.part(&M::layer, rows_of_layer());
  return fields;
}

void CoatedConductorDesc::fill(RowBuilder& row) const {
  using Slots = CoatedConductorSlots;
  row.coat(coat_eta, coat_facets, maps_roughness, layer);
  row.roughness(Slots::conductor_alpha_x, metal_facets, maps_roughness);
  row.metal(Slots::conductor_eta, Slots::conductor_k, metal, row.index(coat_eta));
}

}  // namespace montelux
