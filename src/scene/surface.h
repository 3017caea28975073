// From a hit to the surface there.
#pragma once
#include "geometry/ray.h"
#include "scene/geometry_store.h"

namespace montelux {

template <class F>
struct SurfaceHit {
  SurfacePoint<F> point;
  F distance;  // travelled by the ray, for a unit direction
  Uint<F> material;
  Uint<F> light;   // 1 + number of the light; 0: emits nothing
  Uint<F> object;  // number of the object, from 1
  // The surface faces the incident ray, like curves do: for another ray it is a different surface.
  Mask<F> ray_facing;
  // Whether different media lie on its two sides, and their numbers; `outside` is where the oriented normal points.
  Mask<F> bounds_media;
  Uint<F> inside, outside;
};

// Whether the surface is an interface, everywhere or in part. Lanes without a hit have the number of any geometry.
template <class F>
MONTELUX_INLINE Mask<F> may_be_interface(const GeometryStore& store, const Hit<F>& hit) {
  constexpr std::uint32_t words = sizeof(GeometryRow) / sizeof(std::uint32_t);
  const Uint<F> flags = gather(&store.rows.data()->flags, hit.geometry * Uint<F>(words));
  return (flags & Uint<F>(GeometryRow::invisible_to_shadow_rays | GeometryRow::open_to_some_shadow_rays)) !=
         Uint<F>(0u);
}

// The surface where rays hit the scene, at their time.
template <class F>
SurfaceHit<F> surface(const GeometryStore& store, const Ray<F>& ray, const Hit<F>& hit, Mask<F> on);

// The same point of the same surface at another time: moved with its instance, or with the deformation of its mesh.
template <class F>
SurfaceHit<F> surface_at(const GeometryStore& store, const Ray<F>& ray, const Hit<F>& hit, F time, Mask<F> on);

// The point in the world where one ray hit a surface; `local` is the ray in the space of the hit's instance.
SurfacePoint<float> point_of_local_ray(const GeometryStore& store, const Ray<float>& local, const Hit<float>& hit);

// Surface parameters of a hit, for alpha masks: uv alone, one ray.
Vec2f surface_uv(const GeometryStore& store, const Hit<float>& hit);

}  // namespace montelux
