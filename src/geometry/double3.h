// Vectors in double precision, for computations per shape and per ray rather than per lane.
#pragma once
#include <algorithm>
#include <cmath>

#include "geometry/bounds.h"
#include "math/transform.h"

namespace montelux {

using Vec3d = Vec3<double>;

inline Vec3d to_double(Vec3f a) { return {a.x, a.y, a.z}; }
inline Vec3f to_float(Vec3d a) { return {float(a.x), float(a.y), float(a.z)}; }
inline double norm(Vec3d a) { return std::sqrt(dot(a, a)); }
// Zero stays zero.
inline Vec3d unit(Vec3d a) {
  double n = norm(a);
  return n > 0 ? a * (1 / n) : a;
}
inline double mix(double t, double a, double b) { return (1 - t) * a + t * b; }
inline Vec3d mix(double t, Vec3d a, Vec3d b) { return a * (1 - t) + b * t; }
inline Vec3d abs_of(Vec3d a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }

// D is double, or Doubles of math/double_lanes.h.
template <class D = double>
Vec3<D> transform_direction(const Matrix4& m, const Vec3<D>& d) {
  const auto row = [&](int i) { return m.m[i][0] * d.x + m.m[i][1] * d.y + m.m[i][2] * d.z; };
  return {row(0), row(1), row(2)};
}
template <class D = double>
Vec3<D> transform_point(const Matrix4& m, const Vec3<D>& p) {
  return transform_direction(m, p) + Vec3<D>{m.m[0][3], m.m[1][3], m.m[2][3]};
}
// Multiplies by the inverse transpose, given the `inverse`; not normalised.
inline Vec3d transform_normal(const Matrix4& inverse, Vec3d n) {
  auto column = [&](int j) { return inverse.m[0][j] * n.x + inverse.m[1][j] * n.y + inverse.m[2][j] * n.z; };
  return {column(0), column(1), column(2)};
}

// The box widened by a few units in the last place and a millionth of its size, so that a box test in single precision
// misses nothing and flat boxes have a thickness.
inline Bounds3 padded(Vec3d low, Vec3d high) {
  Vec3d size = high - low;
  double margin = 1e-6 * std::max(size.x, std::max(size.y, size.z));
  auto reach = [&](double a, double b) { return margin + 0x1p-21 * std::max(std::abs(a), std::abs(b)); };
  Vec3d pad{reach(low.x, high.x), reach(low.y, high.y), reach(low.z, high.z)};
  return {to_float(low - pad), to_float(high + pad)};
}

}  // namespace montelux
