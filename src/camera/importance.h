// What the camera sees of the scene, backwards: from a point of the scene to the picture.
#pragma once
#include "mc/density.h"

namespace montelux {

// A point of the scene, or a direction from beyond it, connected with a point of the lens.
//
// A pixel's value is the integral of filter(r) p(x) L(x, r) over places r of the picture, in pixels, and points x of
// the lens, where L is the radiance that comes along the ray of (r, x), and p the density over the lens (Veach 1997,
// sec. 8.2, with the importance We(x, w) |cos| = p(x) dr/dw). So a connection adds
//   filter(raster) across |cos| L / (the probability of the point, per area)
// to a pixel, where cos is that at the point: x is drawn by p, which cancels.
template <class F>
struct LensConnection {
  Vec3<F> p;                // where the camera's ray of `raster` starts
  Vec3<F> d;                // its unit direction, which leads to the point
  F distance;               // to the point
  Vec2<F> raster;           // in pixels, perhaps outside of the picture
  Density<Area, F> across;  // dr/dA: pixels per area at the point, across d
  Density<Area, F> lens;    // p(x), in the space where the camera stands; 1 for a pinhole
  Mask<F> seen;             // false: behind the camera, the other members mean nothing
  bool delta_lens;          // a pinhole: x is certain
};

// The same for a direction: dr/dw instead of dr/dA.
template <class F>
struct LensDirection {
  Vec3<F> p;
  Vec2<F> raster;
  Density<SolidAngle, F> density;  // dr/dw: pixels per steradian
  Density<Area, F> lens;
  Mask<F> seen;  // false where the camera looks along few directions: an orthographic one
  bool delta_lens;
};

// A point at that distance along d.
template <class F>
MONTELUX_INLINE LensConnection<F> connection(const LensDirection<F>& along, const Vec3<F>& d, F distance) {
  return {along.p,    d,          distance,        along.raster, to_area(along.density, distance * distance, F(1.0f)),
          along.lens, along.seen, along.delta_lens};
}

}  // namespace montelux
