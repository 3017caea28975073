// From a hit to the surface there.
#pragma once
#include "geometry/ray.h"
#include "scene/geometry_store.h"

namespace montelux {

template <class F>
struct SurfaceHit {
  SurfacePoint<F> point;
  Uint<F> material;
  Uint<F> light;   // 1 + number of the light; 0: emits nothing
  Uint<F> object;  // number of the object, from 1
};

// The surface where rays with directions d (and origins o) met the scene.
template <class F>
SurfaceHit<F> surface(const GeometryStore& store, const Vec3<F>& o, const Vec3<F>& d, const Hit<F>& hit, Mask<F> on);

// Surface parameters of a hit, for alpha masks: uv alone, one ray.
Vec2f surface_uv(const GeometryStore& store, const Hit<float>& hit);

}  // namespace montelux
