// How the shading normal changes along a surface: for the differentials of rays that are reflected and refracted.
#pragma once
#include "geometry/double3.h"
#include "scene/geometry_store.h"

namespace montelux {

// The derivative of the unit shading normal with respect to the point of the surface, both in world space. It is that
// of the one triangle, patch or quadric at hand, and exact.
class NormalGradient {
 public:
  NormalGradient() = default;  // of a plane
  // Of the normal n (not unit) on tangents pu and pv, along which it changes by nu and nv.
  NormalGradient(const Vec3d& n, const Vec3d& pu, const Vec3d& pv, const Vec3d& nu, const Vec3d& nv);

  // The change of the normal per unit of a parameter that moves the point by `dp`, a tangent of the surface.
  Vec3d along(const Vec3d& dp) const;

 private:
  Vec3d n_{0, 0, 1}, au_{}, av_{}, nu_{}, nv_{};  // au, av: dual to pu, pv; nu, nv over the length of n
};

// At the point p where a ray hit the scene at that time, on triangles, quadrics and patches (not curves), without
// normal maps. Of either orientation: the sign is that of the unit shading normal `ns`.
NormalGradient normal_gradient(const GeometryStore& store, const Hit<float>& hit, const Vec3f& p, const Vec3f& ns,
                               float time);

}  // namespace montelux
