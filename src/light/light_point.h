// A point of a light as it is for everybody, whoever drew it: what can be handed from one reference point to another.
#pragma once
#include "light/light.h"

namespace montelux {

// A point of a surface that emits (measure: area), a direction to a light without bounds that rays meet (measure: solid
// angle), or a light that is a delta (measure: the choice itself). `sort` is one of the words below.
template <class F>
struct LightPoint {
  Vec3<F> p;             // point of the surface; or unit direction toward the light
  Vec3<F> n;             // of the surface: unit, on the side that emits
  Spectrum<F> radiance;  // sent from there to the lit side; of a delta light nothing: it depends on who asks
  Uint<F> light;
  Uint<F> sort;
};

namespace light_point {
inline constexpr std::uint32_t surface = 0, two_sided_surface = 1, infinite = 2, delta = 3;
}  // namespace light_point

// As for WeightedReservoir, in lanes.
template <class F>
MONTELUX_INLINE LightPoint<F> select(Mask<F> m, const LightPoint<F>& a,
                                     const LightPoint<F>& b) requires(lanes_of<F> > 1) {
  return {select(m, a.p, b.p), select(m, a.n, b.n), select(m, a.radiance, b.radiance), select(m, a.light, b.light),
          select(m, a.sort, b.sort)};
}

// A light point drawn at a reference point, without the choice of the light.
template <class F>
struct LightPointDraw {
  LightPoint<F> point;
  Density<SolidAngle, F> density;  // at the reference point; 1 for a delta light
  Mask<F> valid;
};

// A light point as a reference point sees it.
template <class F>
struct LightPointView {
  Vec3<F> wi;
  F distance;
  Spectrum<F> radiance;  // toward the reference point; of a delta light, its irradiance at normal incidence
  F geometry;            // solid angle over the point's own measure: cos / distance^2 for a surface, else 1
  Mask<F> valid;         // no: nothing arrives
};

}  // namespace montelux
