// One out of many candidates on lights, in proportion to what each would contribute if nothing were in the way: a
// shadow ray for that one alone (Talbot, Cline and Egbert 2005, "Importance Resampling for Global Illumination").
#pragma once
#include "light/light_set.h"
#include "mc/resampling.h"
#include "transport/dimensions.h"

namespace montelux {

// The chosen candidate: value / target * mean weight, an estimate of all the light that the candidates would contribute
// if nothing were in the way. Black where none contributes anything.
template <class F>
struct ResampledLight {
  Vec3<F> wi;
  F distance;
  Spectrum<F> value;
  F u_choice;  // that its light was chosen by
};

// draw(u_choice, u) gives a LightSample; value(light, mask) what it contributes if nothing is in the way, not yet
// divided by its density: any function of the direction, so that a weight of multiple importance sampling may be part
// of it.
template <class F, class Draw, class Value>
ResampledLight<F> resample_light(int candidates, RandomStream<F> stream, Mask<F> on, Draw draw, Value value) {
  struct Chosen {
    Vec3<F> wi;
    F distance;
    Spectrum<F> value;
    F target;
    F u_choice;
  };
  const Vec3<F> nowhere{F(0.0f), F(0.0f), F(0.0f)};
  Chosen chosen{nowhere, F(0.0f), gray(F(0.0f)), F(0.0f), F(0.0f)};
  F sum = 0.0f;
  for (int i = 0; i < candidates; ++i) {
    const F u_choice = stream.next();
    const Vec2<F> u = stream.next2();
    const F u_take = stream.next();
    const LightSample<F> light = draw(u_choice, u);
    const Mask<F> queries = on & light.valid;
    const Spectrum<F> contribution = value(light, queries);
    const F target = select(queries, average(contribution), F(0.0f));
    const F weight = select(target > F(0.0f), target / light.density, F(0.0f));
    sum = sum + weight;
    const Mask<F> taken = u_take * sum < weight;
    chosen = {select(taken, light.wi, chosen.wi), select(taken, light.distance, chosen.distance),
              select(taken, contribution, chosen.value), select(taken, target, chosen.target),
              select(taken, u_choice, chosen.u_choice)};
  }
  const F factor = resampling_weight(sum, F(float(candidates)), chosen.target);
  return {chosen.wi, chosen.distance, chosen.value * factor, chosen.u_choice};
}

}  // namespace montelux
