// Light from beyond the scene, the same at every point.
#pragma once
#include "light/row.h"

namespace montelux {

// The same radiance from everywhere. Where only one side matters, directions follow the cosine, else all are alike.
template <class F>
struct UniformInfinite {
  struct Direction {
    Vec3<F> wi;
    Density<SolidAngle, F> density;
  };
  static MONTELUX_INLINE Density<SolidAngle, F> density(Vec3<F> n, Vec3<F> wi) {
    return {select(length_squared(n) > F(0.5f), max(dot(n, wi), F(0.0f)) * inv_pi, F(inv_four_pi))};
  }
  static MONTELUX_INLINE Direction sample(Vec3<F> n, Vec2<F> u) {
    Mask<F> one_side = length_squared(n) > F(0.5f);
    Vec3<F> axis = select(one_side, n, Vec3<F>{F(0.0f), F(0.0f), F(1.0f)});
    F z = select(one_side, safe_sqrt(F(1.0f) - u.x), F(1.0f) - 2.0f * u.x);
    F r = safe_sqrt(F(1.0f) - z * z);
    SinCos<F> phi = sin_cos_two_pi(u.y);
    Vec3<F> wi = Frame<F>::from_normal(axis).to_world({r * phi.cos, r * phi.sin, z});
    return {wi, density(n, wi)};
  }
};

}  // namespace montelux
