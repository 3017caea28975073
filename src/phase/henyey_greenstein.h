// Henyey and Greenstein (1941) with the mean cosine g in (-1, 1); g > 0 scatters forward.
#pragma once
#include "mc/henyey_greenstein.h"
#include "phase/sample.h"

namespace montelux {

template <class F>
class HenyeyGreenstein {
 public:
  MONTELUX_INLINE explicit HenyeyGreenstein(F g) : g_(g) {}

  MONTELUX_INLINE Density<SolidAngle, F> evaluate(const Vec3<F>& wo, const Vec3<F>& wi) const {
    return {henyey_greenstein(-dot(wo, wi), g_)};
  }
  MONTELUX_INLINE PhaseSample<F> sample(const Vec3<F>& wo, Vec2<F> u) const {
    const Vec3<F> wi = sample_henyey_greenstein(-wo, g_, u);
    return {wi, evaluate(wo, wi)};
  }

 private:
  F g_;
};

}  // namespace montelux
