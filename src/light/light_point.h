// A point of a light, independent of the reference point: it can be passed from one reference point to another.
#pragma once
#include "light/light.h"

namespace montelux {

// Where the point of a light can be, which decides its measure.
enum class LightPlace : std::uint32_t {
  surface,            // on an emitting surface; area
  two_sided_surface,  // the same, of one that emits on both sides
  infinite,           // beyond the scene, where rays hit it; solid angle
  delta               // where no ray hits it, at one point or beyond the scene; the choice of the light itself
};
template <class F>
MONTELUX_INLINE Uint<F> in_lanes(LightPlace place) {
  return Uint<F>(std::uint32_t(place));
}

template <class F>
struct LightPoint {
  Vec3<F> p;             // point of the surface; or unit direction towards the light
  Vec3<F> n;             // of the surface: unit, on the side that emits
  Spectrum<F> radiance;  // emitted from there to the lit side; zero for a delta light: depends on the reference point
  Uint<F> light;
  Uint<F> place;  // a LightPlace
};

// The same operation as for WeightedReservoir, in lanes.
template <class F>
MONTELUX_INLINE LightPoint<F> select(Mask<F> m, const LightPoint<F>& a,
                                     const LightPoint<F>& b) requires(lanes_of<F> > 1) {
  return {select(m, a.p, b.p), select(m, a.n, b.n), select(m, a.radiance, b.radiance), select(m, a.light, b.light),
          select(m, a.place, b.place)};
}

// Where a light at one point is, in the lanes that have such a light.
template <class F>
struct LightPosition {
  Vec3<F> p;
  Mask<F> exists;
};

// A light point sampled at a reference point, without the choice of the light.
template <class F>
struct LightPointDraw {
  LightPoint<F> point;
  Density<SolidAngle, F> density;  // at the reference point; 1 for a delta light
  Mask<F> valid;
};

// A light point as seen from a reference point.
template <class F>
struct LightPointView {
  Vec3<F> wi;
  F distance;
  Spectrum<F> radiance;  // towards the reference point; for a delta light, its irradiance at normal incidence
  F geometry;            // solid angle over the point's own measure: cos / distance^2 for a surface, else 1
  Mask<F> valid;         // false: nothing arrives
};

}  // namespace montelux
