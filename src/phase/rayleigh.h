// Rayleigh scattering: clear air, and particles much smaller than the wavelength.
#pragma once
#include "mc/rayleigh.h"
#include "phase/sample.h"

namespace montelux {

template <class F>
class Rayleigh {
 public:
  // It has no parameter.
  MONTELUX_INLINE explicit Rayleigh(F) {}

  MONTELUX_INLINE Density<SolidAngle, F> evaluate(const Vec3<F>& wo, const Vec3<F>& wi) const {
    return {rayleigh(-dot(wo, wi))};
  }
  MONTELUX_INLINE PhaseSample<F> sample(const Vec3<F>& wo, Vec2<F> u) const {
    const Vec3<F> wi = sample_rayleigh(-wo, u);
    return {wi, evaluate(wo, wi)};
  }
};

}  // namespace montelux
