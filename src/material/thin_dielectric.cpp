#include "material/thin_dielectric.h"

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<ThinDielectricDesc> ThinDielectricDesc::rows() {
  using M = ThinDielectricDesc;
  Fields<M> fields;
  index(fields, &M::eta);
  albedo(fields, "tint", &M::tint, "factor of transmitted light (Montelux alone)");
  fields.input<NumberInput>("roughness", &M::roughness, "roughness of reflection and transmission (Montelux alone)", 0,
                            no_upper_bound);
  remap(fields, &M::maps_roughness);
  return fields;
}

void ThinDielectricDesc::fill(RowBuilder& row) const {
  using Slots = ThinDielectricSlots;
  row.put(Slots::eta, row.index(eta));
  row.spectrum(Slots::tint, tint);
  row.number(Slots::alpha, roughness, maps_roughness ? RowEncoding::roughness : RowEncoding::plain);
}

}  // namespace montelux
