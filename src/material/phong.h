// Phong's lobe, in the form that conserves energy and is reciprocal (Lafortune and Willems 1994).
#pragma once
#include "material/bsdf.h"
#include "material/lobe.h"
#include "material/parts.h"
#include "mc/phong_lobe.h"

namespace montelux {

struct PhongSlots {
  static constexpr int diffuse = 0, specular = spectrum_size, exponent = specular + spectrum_size, end = exponent + 1;
  static_assert(fill_bsdf_row(end, {{diffuse, spectrum_size}, {specular, spectrum_size}, {exponent, 1}}));
};

// Lafortune's energy-conserving Phong model.
struct PhongDesc {
  SpectrumInput diffuse_albedo = gray_value(0.5f), glossy_albedo = gray_value(0.3f);
  NumberInput exponent = 32.0f;  // of the glossy lobe

  static constexpr std::string_view meaning = "Lafortune's energy-conserving Phong model";
  static Fields<PhongDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const PhongDesc&) const = default;
};

// f = kd / pi + ks (n + 2) / (2 pi) cos^n alpha, alpha the angle between wi and the mirror direction of wo; on both
// sides. Requires kd + ks <= 1. Directions that the lobe samples below the surface are absorbed.
template <class F>
class Phong {
 public:
  static constexpr std::string_view name = "phong";
  static constexpr bool has_reflection = true, has_transmission = false;
  static constexpr int slot_count = PhongSlots::end;
  using Stated = PhongDesc;
  static constexpr auto facet_slots = no_facets;

  MONTELUX_INLINE explicit Phong(const BsdfRows<F>& rows)
      : kd_(rows.spectrum(PhongSlots::diffuse)),
        ks_(rows.spectrum(PhongSlots::specular)),
        exponent_(rows.number(PhongSlots::exponent)) {
    F d = luminance(to_rgb(kd_)), s = luminance(to_rgb(ks_));
    diffuse_ = d / max(d + s, F(1e-30f));
    black_ = d + s <= F(0.0f);
  }

  MONTELUX_INLINE Mask<F> is_delta() const { return Mask<F>(false); }

  MONTELUX_INLINE BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>&) const {
    Mask<F> reflects = same_side(wo, wi) & !black_;
    F lobe = phong_lobe_density(exponent_, dot(wi, mirrored(wo))).value;
    F cosine = cosine_density(wi);
    F density = diffuse_ * cosine + (F(1.0f) - diffuse_) * lobe;
    F scale = (exponent_ + 2.0f) / (exponent_ + 1.0f) * abs(wi.z);
    Spectrum<F> value = kd_ * cosine + ks_ * (lobe * scale);
    return {select(reflects, value, gray(F(0.0f))), {select(reflects, density, F(0.0f))}};
  }
  MONTELUX_INLINE BsdfSample<F> sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const {
    Vec3<F> lobe = LocalFrame<F>::from_normal(mirrored(wo)).to_world(sample_phong_lobe(exponent_, u2));
    Vec3<F> wi = select(u < diffuse_, sample_cosine_side(wo, u2), lobe);
    BsdfValue<F> value = evaluate(wo, wi, context);
    Mask<F> valid = value.density.value > F(0.0f);
    return {wi, value.f_cos / max(value.density.value, F(1e-30f)), value.density, F(1.0f), valid, Mask<F>(false)};
  }
  // The lobe's directions have its density.
  MONTELUX_INLINE Spectrum<F> albedo(Vec3<F> wo, const BsdfSample<F>&, Vec2<F> u2, const BsdfContext<F>&) const {
    const Vec3<F> wi = LocalFrame<F>::from_normal(mirrored(wo)).to_world(sample_phong_lobe(exponent_, u2));
    const F scale = (exponent_ + 2.0f) / (exponent_ + 1.0f) * abs(wi.z);
    return kd_ + ks_ * select(same_side(wo, wi), scale, F(0.0f));
  }

 private:
  static MONTELUX_INLINE Vec3<F> mirrored(Vec3<F> wo) { return {-wo.x, -wo.y, wo.z}; }

  Spectrum<F> kd_, ks_;
  F exponent_;
  F diffuse_;  // probability of the diffuse part
  Mask<F> black_;
};

}  // namespace montelux
