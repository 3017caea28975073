#include "material/dielectric.h"

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<DielectricDesc> DielectricDesc::rows() {
  using M = DielectricDesc;
  Fields<M> fields;
  index(fields, &M::eta);
  fields.part(&M::facets, rows_of_facets());
  remap(fields, &M::maps_roughness);
  return fields;
}

void DielectricDesc::fill(RowBuilder& row) const {
  row.roughness(DielectricSlots::alpha_x, facets, maps_roughness);
  row.put(DielectricSlots::eta, row.index(eta));
}

}  // namespace montelux
