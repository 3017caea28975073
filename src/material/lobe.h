// Helpers that the models share: sides of the surface, and cosine-weighted directions on either side.
#pragma once
#include "mc/hemisphere.h"

namespace montelux {

template <class F>
MONTELUX_INLINE Mask<F> same_side(Vec3<F> a, Vec3<F> b) {
  return a.z * b.z > F(0.0f);
}
// w or its mirror image below, whichever lies on the side of wo; w.z >= 0.
template <class F>
MONTELUX_INLINE Vec3<F> onto_side(Vec3<F> w, Vec3<F> wo) {
  return {w.x, w.y, copysign(w.z, wo.z)};
}
// A cosine-weighted direction on the side of wo, and its density on its own side.
template <class F>
MONTELUX_INLINE Vec3<F> sample_cosine_side(Vec3<F> wo, Vec2<F> u) {
  return onto_side(sample_cosine_hemisphere(u), wo);
}
template <class F>
MONTELUX_INLINE F cosine_density(Vec3<F> w) {
  return cosine_hemisphere_density(abs(w.z)).value;
}

}  // namespace montelux
