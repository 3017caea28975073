// The parameters of points of quadrics, in object space and double precision.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/double3.h"
#include "geometry/quadric.h"

namespace montelux {

// phi_max in radians.
inline double phi_limit(float phi_max) { return phi_max * (std::numbers::pi / 180); }

// Azimuth in [0, 2 pi).
inline double azimuth(double x, double y) {
  double phi = std::atan2(y, x);
  return phi < 0 ? phi + 2 * std::numbers::pi : phi;
}

struct PolarRange {
  double low, high;  // polar angles at z_min and z_max: v runs from low to high
};
inline PolarRange polar_range(const Sphere& s) {
  auto angle = [&](float z) { return std::acos(std::clamp(double(z) / s.radius, -1.0, 1.0)); };
  return {angle(s.z_min), angle(s.z_max)};
}

// Of the point in this direction from the centre, whose azimuth is phi.
inline Vec2f sphere_uv(const Sphere& s, double cos_theta, double sin_theta, double phi) {
  PolarRange range = polar_range(s);
  double theta = std::atan2(sin_theta, cos_theta);
  double v = range.low == range.high ? 0 : (theta - range.low) / (range.high - range.low);
  return {float(std::min(phi / phi_limit(s.phi_max), 1.0)), float(std::clamp(v, 0.0, 1.0))};
}

}  // namespace montelux
