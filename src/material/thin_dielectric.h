// A pane of glass without thickness: the light between its two faces is summed up.
#pragma once
#include "material/bsdf.h"
#include "material/fresnel.h"

namespace montelux {

struct ThinDielectricSlots {
  static constexpr int eta = 0, tint = 1;
};

// Reflects R' = R + T^2 R / (1 - R^2), the sum over all internal reflections (Stokes 1862), passes the rest straight
// on, multiplied by the tint.
template <class F>
class ThinDielectric {
 public:
  static constexpr std::string_view name = "thindielectric";
  static constexpr bool has_reflection = true, has_transmission = true;

  MONTELUX_INLINE explicit ThinDielectric(const BsdfRows<F>& rows)
      : eta_(rows.number(ThinDielectricSlots::eta)), tint_(rows.spectrum(ThinDielectricSlots::tint)) {}

  MONTELUX_INLINE Mask<F> is_delta() const { return Mask<F>(true); }

  MONTELUX_INLINE BsdfValue<F> evaluate(Vec3<F>, Vec3<F>, const BsdfContext<F>&) const {
    return {gray(F(0.0f)), {F(0.0f)}};
  }
  MONTELUX_INLINE BsdfSample<F> sample(Vec3<F> wo, F u, Vec2<F>, const BsdfContext<F>&) const {
    // R + (1 - R)^2 R / (1 - R^2) = 2 R / (1 + R).
    F r = fresnel_dielectric(abs(wo.z), eta_);
    Mask<F> reflects = u < 2.0f * r / (F(1.0f) + r);
    Vec3<F> wi = select(reflects, Vec3<F>{-wo.x, -wo.y, wo.z}, -wo);
    return {wi, select(reflects, gray(F(1.0f)), tint_), {F(0.0f)}, F(1.0f), wo.z != F(0.0f), Mask<F>(true)};
  }

 private:
  F eta_;
  Spectrum<F> tint_;
};

}  // namespace montelux
