#include "material/diffuse_transmission.h"

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<DiffuseTransmissionDesc> DiffuseTransmissionDesc::rows() {
  using M = DiffuseTransmissionDesc;
  Fields<M> fields;
  albedo(fields, "reflectance", &M::reflected, "albedo of reflection");
  albedo(fields, "transmittance", &M::transmitted, "albedo of transmission");
  fields.number("scale", &M::scale, "factor of both", 0, no_upper_bound);
  return fields;
}

void DiffuseTransmissionDesc::fill(RowBuilder& row) const {
  row.spectrum(DiffuseTransmissionSlots::reflectance, reflected, scale);
  row.spectrum(DiffuseTransmissionSlots::transmittance, transmitted, scale);
}

}  // namespace montelux
