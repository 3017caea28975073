#include "material/tinted_dielectric.h"

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<TintedDielectricDesc> TintedDielectricDesc::rows() {
  using M = TintedDielectricDesc;
  Fields<M> fields;
  index(fields, &M::eta);
  albedo(fields, "tint", &M::tint, "factor of transmitted light");
  fields.spectrum("absorption", &M::absorption, "absorption inside, per unit of length", 0, no_upper_bound);
  fields.part(&M::facets, rows_of_facets());
  remap(fields, &M::maps_roughness);
  return fields;
}

void TintedDielectricDesc::fill(RowBuilder& row) const {
  using Slots = TintedDielectricSlots;
  row.roughness(Slots::alpha_x, facets, maps_roughness);
  row.put(Slots::eta, row.index(eta));
  row.spectrum(Slots::tint, tint);
  row.coefficients(Slots::absorption, absorption);
}

}  // namespace montelux
