// How next-event estimation and the sampling of directions share the light that both can find.
#pragma once
#include "integrator/path/settings.h"
#include "mc/mis.h"

namespace montelux {

// By the densities of both techniques. `infinite`: the light is from infinity.
template <class F>
MONTELUX_INLINE F shared_weight(PathMis mis, const Density<SolidAngle, F>& own, const Density<SolidAngle, F>& other,
                                Mask<F> infinite) {
  if (mis == PathMis::balance) return balance_weight(own, other);
  const F by_power = power_weight(own, other);
  if (mis == PathMis::power || !any(infinite)) return by_power;
  return select(infinite, balance_weight(own, other), by_power);
}

// The weight of light that next-event estimation found, with density `own`. Lights that no direction can meet have the
// weight 1, which the caller knows.
template <class F>
MONTELUX_INLINE F weight_of_light_sample(const LightWeights& weights, const Density<SolidAngle, F>& own,
                                         const Density<SolidAngle, F>& by_bsdf, Mask<F> infinite) {
  if (!weights.nee || weights.mis == PathMis::off) return F(1.0f);
  return shared_weight<F>(weights.mis, own, by_bsdf, infinite);
}

// The weight of light that a path met along a direction of density `own`. `by_delta`: the direction is that of a delta,
// or of the camera, which no light sample could have found.
template <class F>
MONTELUX_INLINE F weight_of_light_hit(const LightWeights& weights, const Density<SolidAngle, F>& own, Mask<F> by_delta,
                                      const Density<SolidAngle, F>& by_light, Mask<F> infinite) {
  if (!weights.nee) return F(1.0f);
  const F shared = weights.mis == PathMis::off ? F(0.0f) : shared_weight<F>(weights.mis, own, by_light, infinite);
  return select((!by_delta) & (by_light.value > F(0.0f)), shared, F(1.0f));
}

}  // namespace montelux
