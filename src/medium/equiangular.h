// Distances along a ray by the angle under which a point beside it sees them: in proportion to the inverse of the
// squared distance from that point (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in
// Participating Media").
#pragma once
#include "math/functions.h"
#include "math/vec.h"

namespace montelux {

template <class F>
class EquiangularDistances {
 public:
  // Of the ray from o along the unit d up to `length`, which may be infinite.
  MONTELUX_INLINE EquiangularDistances(const Vec3<F>& o, const Vec3<F>& d, F length, const Vec3<F>& point)
      : length_(length) {
    const Vec3<F> to_origin = o - point;
    start_ = dot(to_origin, d);
    const F squared = length_squared(to_origin);
    // The distribution is sound for any gap. A point on the ray has this one.
    gap_ = max(montelux::length(to_origin - d * start_), F(1e-6f) * sqrt(squared) + F(1e-15f));
    squared_ = gap_ * gap_ + start_ * start_;
    range_ = atan2(gap_, squared_ / length + start_);
  }

  MONTELUX_INLINE F sample(F u) const {
    const SinCos<F> angle = sin_cos(u * range_);  // from the origin, as the point sees it
    const F t = angle.sin * squared_ / max(gap_ * angle.cos - start_ * angle.sin, F(1e-30f));
    return min(t, length_);
  }
  // Per unit of length.
  MONTELUX_INLINE F density(F t) const {
    const F along = start_ + t;
    return gap_ / (range_ * (gap_ * gap_ + along * along));
  }

 private:
  F start_;    // of the ray, from its point nearest the given one
  F gap_;      // between these two
  F squared_;  // distance of the origin from the point
  F range_;    // angle of the whole ray
  F length_;
};

}  // namespace montelux
