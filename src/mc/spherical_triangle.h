// Directions that hit a triangle, uniform in solid angle.
#pragma once
#include "mc/density.h"

namespace montelux {

// The triangle of three unit directions as seen from the centre of the sphere, prepared for sampling. Below about 1e-6
// steradians single precision no longer separates the corners well, and sampling by area is as good.
template <class F>
struct SphericalTriangle {
  Vec3<F> a, b, c;
  F solid_angle;
  F angle_a;     // between the arcs ab and ac
  F tan_half_c;  // of the arc ab
  Vec3<F> to_c;  // unit, orthogonal to a, along the arc ac

  // From the corners relative to the centre, of any length, in either orientation.
  static MONTELUX_INLINE SphericalTriangle from_corners(Vec3<F> p, Vec3<F> q, Vec3<F> r) {
    SphericalTriangle t;
    t.a = normalize(p), t.b = normalize(q), t.c = normalize(r);
    Vec3<F> ab = t.b - t.a, ac = t.c - t.a;
    Vec3<F> normal_b = cross(t.a, ab), normal_c = cross(t.a, ac);
    F volume = abs(dot(normal_b, ac));
    t.solid_angle = solid_angle_of(t.a, t.b, t.c, volume);
    t.angle_a = atan2(volume, dot(normal_b, normal_c));
    t.tan_half_c = length(ab) / max(length(t.a + t.b), F(1e-20f));
    Vec3<F> s = ac + t.a * (0.5f * dot(ac, ac));
    t.to_c = s * (F(1.0f) / max(length(s), F(1e-30f)));
    return t;
  }

  // Van Oosterom and Strackee 1983; `volume` is |a.(b x c)|.
  static MONTELUX_INLINE F solid_angle_of(Vec3<F> a, Vec3<F> b, Vec3<F> c, F volume) {
    return 2.0f * atan2(volume, F(1.0f) + dot(a, b) + dot(b, c) + dot(c, a));
  }
};

// The first coordinate cuts off the triangle a b c' with that part of the solid angle (Arvo 1995). The corner c'
// follows from tan(E / 2) = xy sin A / (1 + xy cos A), with x and y the tangents of half the arcs at a (from the law of
// cosines, NIST DLMF 4.42): no cancellation in small triangles. The second interpolates along the arc b c'.
template <class F>
MONTELUX_INLINE Vec3<F> sample_spherical_triangle(const SphericalTriangle<F>& t, Vec2<F> u) {
  F half = 0.5f * u.x * t.solid_angle;
  F rise = sin_cos(half).sin;
  F run = t.tan_half_c * max(sin_cos(t.angle_a - half).sin, F(0.0f));
  F norm = F(1.0f) / max(rise * rise + run * run, F(1e-37f));
  Vec3<F> corner = t.a * ((run - rise) * (run + rise) * norm) + t.to_c * (2.0f * rise * run * norm);
  corner = select(rise * rise + run * run > F(1e-37f), corner, t.a);

  Vec3<F> chord = corner - t.b;
  F height = 0.5f * dot(chord, chord);
  Vec3<F> along = chord + t.b * height;
  F below = u.y * height;
  F r = safe_sqrt(below * (F(2.0f) - below));
  return t.b * (F(1.0f) - below) + along * (r / max(length(along), F(1e-30f)));
}

template <class F>
MONTELUX_INLINE Density<SolidAngle, F> spherical_triangle_density(const SphericalTriangle<F>& t) {
  return {select(t.solid_angle > F(0.0f), F(1.0f) / max(t.solid_angle, F(1e-30f)), F(0.0f))};
}

// w inside the triangle.
template <class F>
MONTELUX_INLINE Vec2<F> invert_spherical_triangle(const SphericalTriangle<F>& t, Vec3<F> w) {
  Vec3<F> corner = cross(cross(t.b, w - t.b), cross(t.a, t.c - t.a));
  corner = corner * (copysign(F(1.0f), dot(corner, t.a + t.c)) / max(length(corner), F(1e-30f)));
  F volume = abs(dot(cross(t.a, t.b - t.a), corner - t.a));
  F part = SphericalTriangle<F>::solid_angle_of(t.a, t.b, corner, volume);
  Vec3<F> near = w - t.b, far = corner - t.b;
  return {clamp(part / max(t.solid_angle, F(1e-30f)), 0.0f, one_minus_epsilon),
          clamp(dot(near, near) / max(dot(far, far), F(1e-30f)), 0.0f, one_minus_epsilon)};
}

}  // namespace montelux
