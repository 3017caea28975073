// Directions above a plane that a flat polygon covers.
#pragma once
#include <array>
#include <cmath>

#include "math/vec.h"

namespace montelux {

// Convex, with its corners relative to the point from which it is seen.
struct SeenPolygon {
  std::array<Vec3f, 5> corners{};
  int count = 0;
};

// The part on the side of n: one corner more at most (Sutherland and Hodgman 1974).
inline SeenPolygon above_horizon(const SeenPolygon& polygon, Vec3f n) {
  SeenPolygon part;
  for (int i = 0; i < polygon.count; ++i) {
    const Vec3f a = polygon.corners[std::size_t(i)], b = polygon.corners[std::size_t((i + 1) % polygon.count)];
    const float height_a = dot(a, n), height_b = dot(b, n);
    if (height_a >= 0) part.corners[std::size_t(part.count++)] = a;
    if ((height_a >= 0) != (height_b >= 0))
      part.corners[std::size_t(part.count++)] = a + (b - a) * (height_a / (height_a - height_b));
  }
  return part;
}

// The solid angle of a convex polygon, in steradians: a fan of triangles (Van Oosterom and Strackee 1983, eq. 8).
inline float solid_angle(const SeenPolygon& polygon) {
  double sum = 0;
  for (int i = 1; i + 1 < polygon.count; ++i) {
    const Vec3f a = polygon.corners[0], b = polygon.corners[std::size_t(i)], c = polygon.corners[std::size_t(i) + 1];
    const double la = double(length(a)), lb = double(length(b)), lc = double(length(c));
    const double top = std::abs(double(dot(a, cross(b, c))));
    const double below = la * lb * lc + double(dot(a, b)) * lc + double(dot(a, c)) * lb + double(dot(b, c)) * la;
    sum += 2 * std::atan2(top, below);
  }
  return float(sum);
}

// Whether the direction w, from the origin, meets the polygon.
inline bool covers(const SeenPolygon& polygon, Vec3f w) {
  int left = 0, right = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const Vec3f a = polygon.corners[std::size_t(i)], b = polygon.corners[std::size_t((i + 1) % polygon.count)];
    (dot(cross(a, b), w) >= 0 ? left : right)++;
  }
  // On the same side of every plane through the origin and an edge; a corner excludes the opposite direction.
  if (left != 0 && right != 0) return false;
  Vec3f sum{0, 0, 0};
  for (int i = 0; i < polygon.count; ++i) sum += normalize(polygon.corners[std::size_t(i)]);
  return dot(sum, w) > 0;
}

}  // namespace montelux
