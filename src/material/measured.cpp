#include "material/measured.h"

#include "material/measured_table.h"

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

MeasuredSample sample_measured(const MeasuredTable& table, Vec3f wo, Vec2f u, TransportMode mode) {
  const float side = copysign(1.0f, wo.z);
  const Vec3f o = wo * side;
  const MeasuredTable::Sample above = table.sample(o, u);
  return {above.wi * side, in_mode(mode, table, o, above.wi, above.value)};
}

}  // namespace montelux
