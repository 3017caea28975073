// Rays that start at lights: for paths that follow light from the lamps.
#pragma once
#include "light/light.h"

namespace montelux {

// A ray that a light sends: a point and a direction, each with its density. Lights in one point have no choice of the
// point, distant lights none of the direction: what is drawn there is certain, and its density is 1. Lights without a
// place send rays from a disk across d that touches the sphere around the scene from outside.
template <class F>
struct LightEmission {
  Vec3<F> p;                         // where the ray starts
  Vec3<F> p_error;                   // bound of the absolute rounding error of p on a surface, else zero
  Vec3<F> n;                         // unit, on the side to which the ray leaves; without a surface: d
  Vec3<F> d;                         // unit, away from the light
  Spectrum<F> radiance;              // along d; of a light in one point its intensity, of a distant one its irradiance
  Spectrum<F> flux;                  // radiance |cos| over both densities: its mean is the emitted power, in W
  Density<Area, F> position;         // of p; 1 where delta_position
  Density<SolidAngle, F> direction;  // of d; 1 where delta_direction
  Mask<F> valid, delta_position, delta_direction;
  Mask<F> on_surface, both_sides;  // p is on a surface, which sends the same from its other side
  Mask<F> behind;                  // of a surface: n is opposed to its orientation
};

// The densities with which a ray is drawn; 1 where there is no choice, as above.
template <class F>
struct EmissionDensities {
  Density<Area, F> position;
  Density<SolidAngle, F> direction;
  Mask<F> delta_position, delta_direction;
};

// The numbers in [0, 1)^2 with which a ray is drawn.
template <class F>
struct EmissionNumbers {
  Vec2<F> point, direction;
};

}  // namespace montelux
