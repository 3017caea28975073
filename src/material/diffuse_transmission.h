// A thin sheet that scatters light uniformly into all directions of both sides.
#pragma once
#include "material/bsdf.h"
#include "material/lobe.h"
#include "material/parts.h"

namespace montelux {

struct DiffuseTransmissionSlots {
  static constexpr int reflectance = 0, transmittance = spectrum_size, end = transmittance + spectrum_size;
  static_assert(fill_bsdf_row(end, {{reflectance, spectrum_size}, {transmittance, spectrum_size}}));
};

struct DiffuseTransmissionDesc {
  SpectrumInput reflected = gray_value(0.25f), transmitted = gray_value(0.25f);  // albedos
  float scale = 1;                                                               // factor of both

  static constexpr std::string_view meaning = "Lambertian reflection and transmission";
  static Fields<DiffuseTransmissionDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const DiffuseTransmissionDesc&) const = default;
};

// f = reflectance / pi on the side of wo, transmittance / pi on the other.
template <class F>
class DiffuseTransmission {
 public:
  static constexpr std::string_view name = "diffusetransmission";
  static constexpr bool has_reflection = true, has_transmission = true;
  static constexpr int slot_count = DiffuseTransmissionSlots::end;
  using Stated = DiffuseTransmissionDesc;
  static constexpr auto facet_slots = no_facets;

  MONTELUX_INLINE explicit DiffuseTransmission(const BsdfRows<F>& rows)
      : reflectance_(rows.spectrum(DiffuseTransmissionSlots::reflectance)),
        transmittance_(rows.spectrum(DiffuseTransmissionSlots::transmittance)) {
    F r = max_component(reflectance_), t = max_component(transmittance_);
    reflect_ = r / max(r + t, F(1e-30f));
    black_ = r + t <= F(0.0f);
  }

  MONTELUX_INLINE Mask<F> is_delta() const { return Mask<F>(false); }

  MONTELUX_INLINE BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>&) const {
    Mask<F> reflects = same_side(wo, wi);
    F cosine = select(black_, F(0.0f), cosine_density(wi));
    return {select(reflects, reflectance_, transmittance_) * cosine,
            {cosine * select(reflects, reflect_, F(1.0f) - reflect_)}};
  }
  MONTELUX_INLINE BsdfSample<F> sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>&) const {
    Mask<F> reflects = u < reflect_;
    Vec3<F> wi = sample_cosine_side(select(reflects, wo, -wo), u2);
    F chance = select(reflects, reflect_, F(1.0f) - reflect_);
    Mask<F> valid = (wi.z != F(0.0f)) & !black_ & (chance > F(0.0f));
    Spectrum<F> weight = select(reflects, reflectance_, transmittance_) / max(chance, F(1e-30f));
    return {wi, weight, {cosine_density(wi) * chance}, F(1.0f), valid, Mask<F>(false)};
  }
  MONTELUX_INLINE Spectrum<F> albedo(Vec3<F>, const BsdfSample<F>&, Vec2<F>, const BsdfContext<F>&) const {
    return reflectance_ + transmittance_;
  }

 private:
  Spectrum<F> reflectance_, transmittance_;
  F reflect_;  // probability of the side of wo
  Mask<F> black_;
};

}  // namespace montelux
