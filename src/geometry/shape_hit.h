// The results of the functions of a shape.
#pragma once
#include "geometry/ray.h"
#include "mc/density.h"

namespace montelux {

// Where a ray meets a shape: the parameter t of the ray and the shape's own parameters in [0, 1]^2.
struct ShapeHit {
  float t;
  Vec2f uv;
};

// A point sampled on a shape, with the density per unit of world area.
struct ShapeSample {
  SurfacePoint<float> point;
  Density<Area> density;
};

}  // namespace montelux
