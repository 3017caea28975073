#include "material/conductor.h"

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<ConductorDesc> ConductorDesc::rows() {
  using M = ConductorDesc;
  Fields<M> fields;
  fields.part(&M::metal, rows_of_metal());
  fields.part(&M::facets, rows_of_facets());
  remap(fields, &M::maps_roughness);
  return fields;
}

void ConductorDesc::fill(RowBuilder& row) const {
  row.roughness(ConductorSlots::alpha_x, facets, maps_roughness);
  row.metal(ConductorSlots::eta, ConductorSlots::k, metal, 1);
}

}  // namespace montelux
