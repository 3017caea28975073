// Rays, and where they meet a surface.
#pragma once
#include "math/functions.h"

namespace montelux {

// Points o + t d for t in [0, t_max]; d need not be unit unless stated. time: in [0, 1], on the way from the start to
// the end of the transforms that move; scenes that stand still do not ask for it.
template <class F>
struct Ray {
  Vec3<F> o, d;
  F t_max;
  F time = F(0.0f);
};

// What a ray is traced for: what the camera sees, how a path continues, or whether a light is visible. Some surfaces
// are not there for all of them.
enum class RayUse { camera, path, shadow };

// A distance that ends beyond every scene.
inline constexpr float ray_infinity = 1e30f;

// A point of a surface, as shading needs it. All in world space.
template <class F>
struct SurfacePoint {
  Vec3<F> p;
  Vec3<F> p_error;  // bound of the absolute rounding error of p, by component
  Vec3<F> ng;       // geometric normal, unit, on the side that the surface's orientation says
  Vec3<F> ns;       // shading normal, unit
  Vec3<F> dpdu;     // tangent along u, not normalised
  Vec2<F> uv;
};

// The origin of a ray that leaves p toward w without meeting the surface again: p moved along ng by the rounding
// error's bound (Waechter and Binder 2019; Pharr, Jakob and Humphreys 2023, sec. 6.8.6).
template <class F>
MONTELUX_INLINE Vec3<F> offset_origin(const Vec3<F>& p, const Vec3<F>& p_error, const Vec3<F>& ng, const Vec3<F>& w) {
  F d = dot(abs(ng), p_error);
  Vec3<F> moved = p + ng * copysign(d, dot(ng, w));
  // One more step away from p in the last place, so that the sum's own rounding cannot bring it back.
  auto widen = [](F from, F to) {
    F step = abs(to) * 0x1p-23f;
    return select(to > from, to + step, select(to < from, to - step, to));
  };
  return {widen(p.x, moved.x), widen(p.y, moved.y), widen(p.z, moved.z)};
}

// Shadow rays stop this much short of the light, as a part of their length, lest they meet the light itself.
inline constexpr float shadow_shortening = 1e-4f;

// From p to the point at `distance` along the unit w, and not quite there. The ray aims at that point from where it
// leaves: along w itself it would pass the point by as much as its origin was moved, and meet the surface there.
template <class F>
MONTELUX_INLINE Ray<F> shadow_ray(const Vec3<F>& p, const Vec3<F>& p_error, const Vec3<F>& ng, const Vec3<F>& w,
                                  F distance, F time) {
  const Vec3<F> o = offset_origin(p, p_error, ng, w);
  return {o, w - (o - p) * (F(1.0f) / distance), distance * (1.0f - shadow_shortening), time};
}

}  // namespace montelux
