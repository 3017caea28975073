// How next-event estimation and the sampling of directions share the light that both can find.
#pragma once
#include "integrator/path/settings.h"
#include "mc/mis.h"

namespace montelux {

// The weight of light that next-event estimation found, with density `own`. Lights that no direction can meet have the
// weight 1, which the caller knows.
template <class F>
MONTELUX_INLINE F weight_of_light_sample(const LightWeights& weights, const Density<SolidAngle, F>& own,
                                         const Density<SolidAngle, F>& by_bsdf) {
  if (!weights.nee || weights.mis == PathMis::off) return F(1.0f);
  return weights.mis == PathMis::balance ? balance_weight(own, by_bsdf) : power_weight(own, by_bsdf);
}

// The weight of light that a path met along a direction of density `own`. `by_delta`: the direction is that of a delta,
// or of the camera, which no light sample could have found.
template <class F>
MONTELUX_INLINE F weight_of_light_hit(const LightWeights& weights, const Density<SolidAngle, F>& own, Mask<F> by_delta,
                                      const Density<SolidAngle, F>& by_light) {
  if (!weights.nee) return F(1.0f);
  const F shared = weights.mis == PathMis::off       ? F(0.0f)
                   : weights.mis == PathMis::balance ? balance_weight(own, by_light)
                                                     : power_weight(own, by_light);
  return select((!by_delta) & (by_light.value > F(0.0f)), shared, F(1.0f));
}

}  // namespace montelux
