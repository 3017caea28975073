// Rays, and the points where they meet a surface.
#pragma once
#include "math/functions.h"

namespace montelux {

// Points o + t d for t in [0, t_max]; d need not be unit unless stated. time: in [0, 1], relative to the start and
// the end of the moving transforms; static scenes do not use it.
template <class F>
struct Ray {
  Vec3<F> o, d;
  F t_max;
  F time = F(0.0f);
};

// The purpose of a ray: what the camera sees, how a path continues, or whether a light is visible. Some surfaces
// do not exist for all of them.
enum class RayUse { camera, path, shadow };

// A distance larger than every scene.
inline constexpr float ray_infinity = 1e30f;

// A point of a surface with everything that shading needs. All in world space.
template <class F>
struct SurfacePoint {
  Vec3<F> p;
  Vec3<F> p_error;  // bound of the absolute rounding error of p, by component
  Vec3<F> ng;       // geometric normal, unit, on the side given by the surface's orientation
  Vec3<F> ns;       // shading normal, unit
  Vec3<F> dpdu;     // tangent along u, not normalised
  Vec2<F> uv;
};

// The origin of a ray that leaves p towards w without meeting the surface again: p offset along ng by the bound of the
// rounding error (Waechter and Binder 2019; Pharr, Jakob and Humphreys 2023, sec. 6.8.6).
template <class F>
MONTELUX_INLINE Vec3<F> offset_origin(const Vec3<F>& p, const Vec3<F>& p_error, const Vec3<F>& ng, const Vec3<F>& w) {
  F d = dot(abs(ng), p_error);
  Vec3<F> moved = p + ng * copysign(d, dot(ng, w));
  // One more step away from p in the last place, so that the rounding of the sum cannot undo the offset.
  auto widen = [](F from, F to) {
    F step = abs(to) * 0x1p-23f;
    return select(to > from, to + step, select(to < from, to - step, to));
  };
  return {widen(p.x, moved.x), widen(p.y, moved.y), widen(p.z, moved.z)};
}

// Shadow rays are shortened by this share of their length so that they do not hit the light itself.
inline constexpr float shadow_shortening = 1e-4f;

// From p to just before the point at `distance` along the unit w. The ray aims at that point from its offset
// origin: along w itself it would miss the point by as much as its origin was moved, and meet the surface there.
template <class F>
MONTELUX_INLINE Ray<F> shadow_ray(const Vec3<F>& p, const Vec3<F>& p_error, const Vec3<F>& ng, const Vec3<F>& w,
                                  F distance, F time) {
  const Vec3<F> o = offset_origin(p, p_error, ng, w);
  return {o, w - (o - p) * (F(1.0f) / distance), distance * (1.0f - shadow_shortening), time};
}

}  // namespace montelux
