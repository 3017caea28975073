// Points of a regular polygon.
#pragma once
#include "mc/disk.h"

namespace montelux {

// Uniform on the polygon of n >= 3 corners on the unit circle, the first at (1, 0). Sectors of the disk map to the
// triangles between the centre and the sides, each ring to a scaled copy of the boundary: the map from the square is
// continuous and keeps areas up to a constant, so that strata remain strata.
template <class F>
MONTELUX_INLINE Vec2<F> sample_regular_polygon(Vec2<F> u, int n) {
  const PolarPlace<F> place = concentric_place(u);
  F turns = place.turns + select(place.r < F(0.0f), F(0.5f), F(0.0f));
  turns = turns - floor(turns);
  const F along = turns * float(n), side = floor(along), w = along - side;
  const SinCos<F> from = sin_cos_two_pi(side * (1.0f / float(n))),
                  to = sin_cos_two_pi((side + 1.0f) * (1.0f / float(n)));
  const F r = abs(place.r);
  return {r * (from.cos * (F(1.0f) - w) + to.cos * w), r * (from.sin * (F(1.0f) - w) + to.sin * w)};
}

// A point as its share r of the distance to the boundary, and where the ray through it meets the boundary, in sides.
template <class F>
struct RimPlace {
  F r, along;
};
template <class F>
MONTELUX_INLINE RimPlace<F> rim_place(Vec2<F> p, int n) {
  F turns = atan2(p.y, p.x) * inv_two_pi;
  turns = turns - floor(turns);
  const F side = min(floor(turns * float(n)), F(float(n - 1)));
  // Rotated so that the middle of the side lies along x.
  const SinCos<F> middle = sin_cos_two_pi((side + 0.5f) * (1.0f / float(n)));
  const SinCos<F> half = sin_cos_two_pi(F(0.5f / float(n)));
  const F x = p.x * middle.cos + p.y * middle.sin, y = p.y * middle.cos - p.x * middle.sin;
  const F r = x / half.cos;
  const F w = 0.5f * (y / max(r * half.sin, F(1e-30f)) + 1.0f);
  return {r, side + clamp(w, 0.0f, 1.0f)};
}

template <class F>
MONTELUX_INLINE Vec2<F> invert_regular_polygon(Vec2<F> p, int n) {
  const RimPlace<F> rim = rim_place(p, n);
  const SinCos<F> azimuth = sin_cos_two_pi(rim.along * (1.0f / float(n)));
  return invert_disk_concentric<F>({rim.r * azimuth.cos, rim.r * azimuth.sin});
}

// Density per unit area inside the polygon.
template <class F>
MONTELUX_INLINE Density<Area, F> regular_polygon_density(Vec2<F> p, int n) {
  const SinCos<float> sector = sin_cos_two_pi(1.0f / float(n));
  return {select(rim_place(p, n).r <= F(1.0f), F(2.0f / (float(n) * sector.sin)), F(0.0f))};
}

}  // namespace montelux
