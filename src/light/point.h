// Lights in one point: each states its place and its intensity (W / sr) toward a unit direction.
#pragma once
#include "light/row.h"

namespace montelux {

// The same in all directions.
template <class F>
struct PointEmitter {
  Vec3<F> p;
  Spectrum<F> emission;

  explicit MONTELUX_INLINE PointEmitter(const LightRows<F>& r) : p(r.vec3(light_slot::shape)), emission(r.emission()) {}
  MONTELUX_INLINE Spectrum<F> intensity(Vec3<F>, Mask<F>) const { return emission; }
};

}  // namespace montelux
