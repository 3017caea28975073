#include "material/measured.h"

#include "material/measured_table.h"
#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

namespace {

// From the value that radiance has, for directions above the surface.
BsdfValue<float> in_mode(TransportMode mode, const MeasuredTable& table, Vec3f wo, Vec3f wi, BsdfValue<float> value) {
  if (mode == TransportMode::importance && value.density.value > 0)
    value.f_cos = table.evaluate(wi, wo).f_cos * (wi.z / wo.z);
  return value;
}

}  // namespace

BsdfValue<float> evaluate_measured(const MeasuredTable& table, Vec3f wo, Vec3f wi, TransportMode mode) {
  const float side = copysign(1.0f, wo.z);
  const Vec3f o = wo * side, i = wi * side;
  return in_mode(mode, table, o, i, table.evaluate(o, i));
}

bool is_anisotropic(const MeasuredTable* table) { return table && !table->is_isotropic(); }

MeasuredSample sample_measured(const MeasuredTable& table, Vec3f wo, Vec2f u, TransportMode mode) {
  const float side = copysign(1.0f, wo.z);
  const Vec3f o = wo * side;
  const MeasuredTable::Sample above = table.sample(o, u);
  return {above.wi * side, in_mode(mode, table, o, above.wi, above.value)};
}

Fields<MeasuredDesc> MeasuredDesc::rows() {
  Fields<MeasuredDesc> fields;
  fields.words("filename", &MeasuredDesc::file, "file of the table, *.bsdf of the RGL material database");
  return fields;
}

void MeasuredDesc::fill(RowBuilder& row) const {
  if (file.empty())
    row.error("a measured material needs the file of its table");
  else
    row.table(MeasuredSlots::table, file);
}

}  // namespace montelux
