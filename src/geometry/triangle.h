// A point of a triangle, in one lane or many.
#pragma once
#include "geometry/ray.h"

namespace montelux {

// World-space corners and texture coordinates (if a mesh has none: those of `default_triangle_uv`).
template <class F>
struct TriangleCorners {
  Vec3<F> p0, p1, p2;
  Vec2<F> uv0{F(0.0f), F(0.0f)}, uv1{F(1.0f), F(0.0f)}, uv2{F(1.0f), F(1.0f)};
};

// World-space vertex normals (not unit) where `present`; elsewhere the values do not matter.
template <class F>
struct TriangleNormals {
  Vec3<F> n0, n1, n2;
  Mask<F> present;
};

inline constexpr Vec2f default_triangle_uv[3] = {{0, 0}, {1, 0}, {1, 1}};

// (1-u-v) a0 + u a1 + v a2.
template <class F>
MONTELUX_INLINE Vec3<F> interpolate(Vec3<F> a0, Vec3<F> a1, Vec3<F> a2, F u, F v) {
  return a0 * (F(1.0f) - u - v) + a1 * u + a2 * v;
}

// A tangent along the first texture coordinate of the triangle with edges e1 = p1 - p0, e2 = p2 - p0, or any vector
// orthogonal to the unit normal if the coordinates are degenerate.
template <class F>
MONTELUX_INLINE Vec3<F> triangle_tangent(const TriangleCorners<F>& c, Vec3<F> e1, Vec3<F> e2, Vec3<F> normal) {
  Vec2<F> d1 = c.uv1 - c.uv0, d2 = c.uv2 - c.uv0;
  F determinant = d1.x * d2.y - d1.y * d2.x;
  F scale = (abs(d1.x) + abs(d1.y)) * (abs(d2.x) + abs(d2.y));
  Mask<F> good = abs(determinant) > max(scale * 1e-6f, F(1e-30f));
  Vec3<F> along = (e1 * d2.y - e2 * d1.y) * (F(1.0f) / select(good, determinant, F(1.0f)));
  good = good & (max_component(abs(along)) > F(0.0f));
  return select<F>(good, along, LocalFrame<F>::from_normal(normal).s);
}

// The point with barycentric coordinates (1-u-v, u, v). p_error bounds the rounding of the interpolation (Pharr, Jakob
// and Humphreys 2023, sec. 6.8.5). ng is on the side of the interpolated normals if there are any, else that of
// (p1 - p0) x (p2 - p0), reversed in lanes of `flip` (reversed orientation, or, exclusively, a transform that swaps
// handedness).
template <class F>
MONTELUX_INLINE SurfacePoint<F> triangle_point(const TriangleCorners<F>& c, const TriangleNormals<F>& normals,
                                               Mask<F> flip, F u, F v) {
  F w = F(1.0f) - u - v;
  SurfacePoint<F> s;
  s.p = c.p0 * w + c.p1 * u + c.p2 * v;
  constexpr float epsilon = 0x1p-24f, gamma7 = 7 * epsilon / (1 - 7 * epsilon);
  s.p_error = (abs(c.p0 * w) + abs(c.p1 * u) + abs(c.p2 * v)) * gamma7;

  // Edges scaled to about one, so that the products of tiny or huge triangles neither vanish nor overflow.
  Vec3<F> e1 = c.p1 - c.p0, e2 = c.p2 - c.p0;
  F size = max(max_component(abs(e1)), max_component(abs(e2)));
  F inverse_size = F(1.0f) / max(size, F(1e-30f));
  Vec3<F> n = cross(e1 * inverse_size, e2 * inverse_size);
  F squared = dot(n, n);
  Mask<F> proper = squared > F(0.0f);
  Vec3<F> up{F(0.0f), F(0.0f), F(1.0f)};
  n = select<F>(proper, n * (F(1.0f) / sqrt(select(proper, squared, F(1.0f)))), up);

  Vec3<F> shading = normals.n0 * w + normals.n1 * u + normals.n2 * v;
  F shading_squared = dot(shading, shading);
  Mask<F> has_shading = normals.present & (shading_squared > F(0.0f)) & is_finite(shading_squared);
  shading = shading * (F(1.0f) / sqrt(select(has_shading, shading_squared, F(1.0f))));
  F side = select(has_shading, copysign(F(1.0f), dot(n, shading)), select(flip, F(-1.0f), F(1.0f)));
  s.ng = n * side;
  s.ns = select<F>(has_shading, shading, s.ng);
  s.dpdu = triangle_tangent(c, e1, e2, n);
  s.uv = c.uv0 * w + c.uv1 * u + c.uv2 * v;
  return s;
}

}  // namespace montelux
