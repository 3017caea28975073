// Lights: what they send toward a point, with which density a point of them is drawn, and which light is chosen.
#pragma once
#include "color/spectrum.h"
#include "mc/density.h"

namespace montelux {

// A direction toward a light, drawn at a reference point.
template <class F>
struct LightSample {
  Vec3<F> wi;                      // unit, from the reference point to the light
  F distance;                      // to the point of the light; infinite lights: beyond the scene
  Spectrum<F> radiance;            // arriving along wi if nothing is in the way; for a delta light, its irradiance at
                                   // normal incidence divided by the choice's probability
  Density<SolidAngle, F> density;  // of wi, the choice of the light included; 1 for a delta light
  Mask<F> valid;
  Mask<F> delta;  // point, spot, distant...: no other technique can find it
};

// What a ray that met a light finds there.
template <class F>
struct LightHit {
  Spectrum<F> radiance;            // toward the reference point
  Density<SolidAngle, F> density;  // with which sample() would have drawn this direction, the choice included
};

}  // namespace montelux
