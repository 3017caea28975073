// Directions that hit a rectangle, uniform in solid angle (Urena, Fajardo and King 2013, "An Area-Preserving
// Parametrization for Spherical Rectangles").
#pragma once
#include "mc/spherical_triangle.h"

namespace montelux {

// A rectangle relative to the centre of the sphere, prepared for sampling. Below about 1e-4 steradians single precision
// blurs the map by more than a thousandth, and sampling by area is as good.
template <class F>
struct SphericalRectangle {
  LocalFrame<F> frame;   // s and t along the edges, n from the rectangle to the centre
  F x0, x1, y0, y1, z0;  // the rectangle in the frame; z0 <= 0
  F b0, b1, k;           // the paper's constants
  F solid_angle;

  // From a corner relative to the centre and two orthogonal edges from it.
  static MONTELUX_INLINE SphericalRectangle from_edges(Vec3<F> corner, Vec3<F> edge_x, Vec3<F> edge_y) {
    SphericalRectangle r;
    F width = length(edge_x), height = length(edge_y);
    r.frame.s = edge_x / width, r.frame.t = edge_y / height;
    Vec3<F> n = cross(r.frame.s, r.frame.t);
    r.frame.n = n * copysign(F(1.0f), -dot(corner, n));
    r.x0 = dot(corner, r.frame.s), r.y0 = dot(corner, r.frame.t), r.z0 = dot(corner, r.frame.n);
    r.x1 = r.x0 + width, r.y1 = r.y0 + height;
    // Heights of the normals of the planes through the centre and an edge: n0 over y0, n2 over y1, n3 over x0.
    const auto height_of = [&](F edge) { return edge / sqrt(r.z0 * r.z0 + edge * edge); };
    F n0 = -height_of(r.y0), n2 = height_of(r.y1), n3 = -height_of(r.x0);
    F g2 = acos(-(n2 * n3)), g3 = acos(-(n3 * n0));
    r.b0 = n0, r.b1 = n2;
    r.k = 2.0f * F(pi) - g2 - g3;
    r.solid_angle = r.solid_angle_up_to(r.x1);
    return r;
  }

  // The solid angle of the part between x0 and x, as two triangles: without cancellation in small ones.
  MONTELUX_INLINE F solid_angle_up_to(F x) const {
    Vec3<F> p = normalize(Vec3<F>{x0, y0, z0}), q = normalize(Vec3<F>{x, y0, z0});
    Vec3<F> s = normalize(Vec3<F>{x, y1, z0}), t = normalize(Vec3<F>{x0, y1, z0});
    const auto triangle = [](Vec3<F> a, Vec3<F> b, Vec3<F> c) {
      return SphericalTriangle<F>::solid_angle_of(a, b, c, abs(dot(cross(a, b - a), c - a)));
    };
    return triangle(p, q, s) + triangle(p, s, t);
  }
};

// A unit direction.
template <class F>
MONTELUX_INLINE Vec3<F> sample_spherical_rectangle(const SphericalRectangle<F>& r, Vec2<F> u) {
  SinCos<F> turn = sin_cos(u.x * r.solid_angle + r.k);
  F f = (turn.cos * r.b0 - r.b1) / turn.sin;
  F c = clamp(copysign(F(1.0f), f) / sqrt(f * f + r.b0 * r.b0), -1.0f, 1.0f);
  F x = clamp(-(c * r.z0) / max(safe_sqrt(F(1.0f) - c * c), F(1e-7f)), r.x0, r.x1);
  F d2 = x * x + r.z0 * r.z0;
  F h0 = r.y0 / sqrt(d2 + r.y0 * r.y0), h1 = r.y1 / sqrt(d2 + r.y1 * r.y1);
  F h = h0 + u.y * (h1 - h0);
  F y = clamp(h * sqrt(d2) / max(safe_sqrt((F(1.0f) - h) * (F(1.0f) + h)), F(1e-7f)), r.y0, r.y1);
  return normalize(r.frame.to_world({x, y, r.z0}));
}

template <class F>
MONTELUX_INLINE Density<SolidAngle, F> spherical_rectangle_density(const SphericalRectangle<F>& r) {
  return {select(r.solid_angle > F(0.0f), F(1.0f) / max(r.solid_angle, F(1e-30f)), F(0.0f))};
}

// w inside the rectangle.
template <class F>
MONTELUX_INLINE Vec2<F> invert_spherical_rectangle(const SphericalRectangle<F>& r, Vec3<F> w) {
  Vec3<F> local = r.frame.to_local(w);
  F scale = r.z0 / local.z;
  F x = clamp(local.x * scale, r.x0, r.x1), y = clamp(local.y * scale, r.y0, r.y1);
  F d2 = x * x + r.z0 * r.z0;
  F h0 = r.y0 / sqrt(d2 + r.y0 * r.y0), h1 = r.y1 / sqrt(d2 + r.y1 * r.y1), h = y / sqrt(d2 + y * y);
  return {clamp(r.solid_angle_up_to(x) / r.solid_angle, 0.0f, one_minus_epsilon),
          clamp((h - h0) / (h1 - h0), 0.0f, one_minus_epsilon)};
}

}  // namespace montelux
