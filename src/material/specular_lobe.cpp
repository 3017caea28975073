#include "material/specular_lobe.h"

namespace montelux {

namespace {

SpecularLobe interface_lobe(float eta, const Spectrum<float>& tint, float cos_o, bool reflects) {
  const float reflected = fresnel_dielectric(cos_o, eta);
  if (reflects) return {gray(reflected)};
  const float relative = cos_o < 0 ? 1 / eta : eta;
  return {tint * ((1 - reflected) / (relative * relative)), relative};
}

}  // namespace

SpecularLobe specular_lobe(BsdfKind kind, const BsdfSlots<float>& slots, float cos_o, bool reflects) {
  const BsdfRows<float> row{&slots};
  switch (kind) {
    case BsdfKind::conductor:
      if (!reflects) break;
      return {fresnel_conductor(std::abs(cos_o), row.spectrum(ConductorSlots::eta), row.spectrum(ConductorSlots::k))};
    case BsdfKind::dielectric:
      return interface_lobe(row.number(DielectricSlots::eta), gray(1.0f), cos_o, reflects);
    case BsdfKind::tinted_dielectric:
      return interface_lobe(row.number(DielectricSlots::eta), row.spectrum(TintedDielectricSlots::tint), cos_o,
                            reflects);
    case BsdfKind::thin_dielectric: {
      // Between the two faces, as ThinDielectric sums it.
      const float r = fresnel_dielectric(std::abs(cos_o), row.number(ThinDielectricSlots::eta)), both = 2 * r / (1 + r);
      if (reflects) return {gray(both)};
      return {row.spectrum(ThinDielectricSlots::tint) * (1 - both)};
    }
    default:
      break;
  }
  return {gray(0.0f)};
}

}  // namespace montelux
