#include "material/phong.h"

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<PhongDesc> PhongDesc::rows() {
  using M = PhongDesc;
  Fields<M> fields;
  albedo(fields, "kd", &M::diffuse_albedo, "diffuse albedo");
  albedo(fields, "ks", &M::glossy_albedo, "glossy albedo");
  fields.input<NumberInput>("exponent", &M::exponent, "exponent of the glossy lobe", 0, 1e6);
  return fields;
}

void PhongDesc::fill(RowBuilder& row) const {
  row.spectrum(PhongSlots::diffuse, diffuse_albedo);
  row.spectrum(PhongSlots::specular, glossy_albedo);
  row.number(PhongSlots::exponent, exponent);
}

}  // namespace montelux
