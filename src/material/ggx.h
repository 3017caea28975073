// Facets of a rough surface as used by the models of metal and glass: on both sides, and as a mirror when nearly
// flat.
#pragma once
#include "mc/microfacet.h"

namespace montelux {

template <class F>
class GgxFacets {
 public:
  GgxFacets() = default;
  MONTELUX_INLINE GgxFacets(F alpha_x, F alpha_y)
      : smooth_(max(alpha_x, alpha_y) < F(1e-3f)), alpha_{max(alpha_x, F(1e-4f)), max(alpha_y, F(1e-4f))} {}

  // So nearly flat that it is replaced by a mirror: both roughnesses below 1e-3.
  MONTELUX_INLINE Mask<F> is_smooth() const { return smooth_; }

  MONTELUX_INLINE Roughness<F> roughness() const { return alpha_; }

  // A facet, m.z > 0, that is visible from wo (on either side); its density is `seen`.
  MONTELUX_INLINE Vec3<F> sample(Vec3<F> wo, Vec2<F> u) const { return sample_visible_normal(above(wo), alpha_, u); }
  MONTELUX_INLINE F seen(Vec3<F> wo, Vec3<F> m) const { return visible_normal_density(above(wo), m, alpha_).value; }
  // Of the facets visible from wo, the fraction that is also visible from wi.
  MONTELUX_INLINE F unshadowed(Vec3<F> wo, Vec3<F> wi) const {
    F o = F(1.0f) + ggx_lambda(wo, alpha_);
    return o / (o + ggx_lambda(wi, alpha_));
  }

 private:
  static MONTELUX_INLINE Vec3<F> above(Vec3<F> w) { return w * copysign(F(1.0f), w.z); }

  Mask<F> smooth_;
  Roughness<F> alpha_;
};

}  // namespace montelux
