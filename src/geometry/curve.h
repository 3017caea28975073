// Thin curves: pbrt's `curve` shape as cubic Bezier segments with radii.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/ray.h"
#include "math/result.h"
#include "math/transform.h"

namespace montelux {

// flat: a band that faces the ray; cylinder: the same band with the normals of a round tube; ribbon: a band with
// normals of its own.
enum class CurveType { flat, cylinder, ribbon };
enum class CurveBasis { bezier, bspline };

// A curve as stated in a file, in object space. Bezier segments share their end points; a B-spline is uniform and
// advances by one point per segment. The width is linear from width0 to width1 over all segments.
struct CurveDesc {
  std::vector<Vec3f> points;
  CurveBasis basis = CurveBasis::bezier;
  int degree = 3;  // 2 or 3
  CurveType type = CurveType::flat;
  std::vector<Vec3f> normals{};  // for ribbons: one at each end of a segment, segments + 1 in all
  float width0 = 1, width1 = 1;
};

struct CurveControl {
  float x, y, z, radius;  // half the width
};

// Cubic Bezier segments: segment s has controls[first[s]] and the three that follow; for ribbons `normals` are Bezier
// controls of the normal, one for each control. flip_normal reverses the normals of ribbons.
struct CurveSet {
  CurveType type = CurveType::flat;
  std::vector<CurveControl> controls;
  std::vector<std::uint32_t> first;
  std::vector<Vec3f> normals;
  bool flip_normal = false;
};

// Degree elevation and change of basis are exact. Fails for a degree other than 2 or 3, for a number of points that
// does not form complete segments, and for a ribbon whose normals do not match its segments.
Result<CurveSet> make_curves(const CurveDesc& desc);

// In world space; widths scale by the cube root of the change of volume, exact for similarities.
CurveSet to_world(const CurveSet& curves, const Transform& object_to_world, bool reverse_orientation);

// Combines both sets; they must have the same type and orientation.
void append(CurveSet& to, const CurveSet& more);

// The surface point where a world-space ray meets a segment at parameters t and u. uv is (u along the segment, v across
// in [0, 1], growing along ray.d x dp/du or, for ribbons, normal x dp/du). Flat and cylinder normals face the ray, the
// latter rotated by 180 (v - 1/2) degrees about the curve. p_error is the width (Pharr, Jakob and Humphreys 2023, sec.
// 6.7), so that a ray that leaves does not hit the same band.
SurfacePoint<float> curve_point(const CurveSet& curves, std::uint32_t segment, float u, const Ray<float>& ray, float t);

}  // namespace montelux
