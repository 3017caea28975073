// The ends of paths at lights, with the densities of all ways to draw them.
#pragma once
#include "integrator/bidirectional/strategy_weights.h"
#include "scene/scene.h"
#include "transport/light_met.h"

namespace montelux {

// The lights of a scene, and the choice among them by which paths start there.
struct PathLights {
  const LightSet& lights;
  const AliasTable& by_power;
};

// The light `at` sends light along the unit d to a vertex that is this far away; `sampled`: the density with which
// light sampling draws it there, the choice included.
template <class F>
LightEnd<F> light_end(const PathLights& from, const MetLight<F>& at, const Vec3<F>& d, F distance_squared,
                      Density<SolidAngle, F> sampled) {
  const LightSet& lights = from.lights;
  const EmissionDensities<F> p = lights.template emission_densities<F>(at.number, at.p, at.n, d, at.on);
  const Mask<F> beyond = lights.template is_beyond<F>(at.number, at.on);
  const Mask<F> delta = p.delta_position | p.delta_direction;
  const F spread = F(1.0f) / max(distance_squared, F(1e-30f));
  const Uint<F> number = select(at.on, at.number, Uint<F>(0u));
  // Light from beyond the scene is as wide as where it starts.
  const F emitted = p.position.value * p.direction.value * select(beyond, F(1.0f), spread);
  return {sampled, from.by_power.template mass<F>(number) * Density<LightAndArea, F>{emitted},
          select(beyond | delta, F(1.0f), abs(dot(at.n, d)) * spread), delta};
}

}  // namespace montelux
