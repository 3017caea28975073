// A direction drawn from a phase function.
#pragma once
#include "math/vec.h"
#include "mc/density.h"

namespace montelux {

template <class F>
struct PhaseSample {
  Vec3<F> wi;
  Density<SolidAngle, F> density;  // of wi; also the value of the phase function, since the draw is exact
};

}  // namespace montelux
