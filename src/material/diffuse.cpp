#include "material/diffuse.h"

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<DiffuseDesc> DiffuseDesc::rows() {
  Fields<DiffuseDesc> fields;
  montelux::albedo(fields, "reflectance", &DiffuseDesc::albedo, "albedo");
  return fields;
}

void DiffuseDesc::fill(RowBuilder& row) const { row.spectrum(DiffuseSlots::reflectance, albedo); }

}  // namespace montelux
