// Vectors of two and three reals. One type serves points, directions and normals; names distinguish them.
#pragma once
#include "math/lanes.h"

namespace montelux {

template <class F>
struct Vec2 {
  F x, y;
};

template <class F>
struct Vec3 {
  F x, y, z;
};

using Vec2f = Vec2<float>;
using Vec3f = Vec3<float>;

// clang-format off
template <class F> MONTELUX_INLINE Vec2<F> operator+(Vec2<F> a, Vec2<F> b) { return {a.x + b.x, a.y + b.y}; }
template <class F> MONTELUX_INLINE Vec2<F> operator-(Vec2<F> a, Vec2<F> b) { return {a.x - b.x, a.y - b.y}; }
template <class F> MONTELUX_INLINE Vec2<F> operator*(Vec2<F> a, std::type_identity_t<F> s) { return {a.x * s, a.y * s}; }

template <class F> MONTELUX_INLINE Vec3<F> operator+(Vec3<F> a, Vec3<F> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class F> MONTELUX_INLINE Vec3<F> operator-(Vec3<F> a, Vec3<F> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class F> MONTELUX_INLINE Vec3<F> operator*(Vec3<F> a, Vec3<F> b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
template <class F> MONTELUX_INLINE Vec3<F> operator*(Vec3<F> a, std::type_identity_t<F> s) { return {a.x * s, a.y * s, a.z * s}; }
template <class F> MONTELUX_INLINE Vec3<F> operator*(std::type_identity_t<F> s, Vec3<F> a) { return a * s; }
template <class F> MONTELUX_INLINE Vec3<F> operator/(Vec3<F> a, std::type_identity_t<F> s) { return a * (1.0f / s); }
template <class F> MONTELUX_INLINE Vec3<F> operator-(Vec3<F> a) { return {-a.x, -a.y, -a.z}; }
template <class F> MONTELUX_INLINE Vec3<F>& operator+=(Vec3<F>& a, Vec3<F> b) { return a = a + b; }

template <class F> MONTELUX_INLINE F dot(Vec3<F> a, Vec3<F> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class F> MONTELUX_INLINE F abs_dot(Vec3<F> a, Vec3<F> b) { return abs(dot(a, b)); }
template <class F> MONTELUX_INLINE Vec3<F> cross(Vec3<F> a, Vec3<F> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F> MONTELUX_INLINE F length_squared(Vec3<F> a) { return dot(a, a); }
template <class F> MONTELUX_INLINE F length(Vec3<F> a) { return sqrt(dot(a, a)); }
// a must not be zero.
template <class F> MONTELUX_INLINE Vec3<F> normalize(Vec3<F> a) { return a * (F(1.0f) / length(a)); }
template <class F> MONTELUX_INLINE Vec3<F> abs(Vec3<F> a) { return {abs(a.x), abs(a.y), abs(a.z)}; }
template <class F> MONTELUX_INLINE F max_component(Vec3<F> a) { return max(a.x, max(a.y, a.z)); }
template <class F> MONTELUX_INLINE Vec3<F> min(Vec3<F> a, Vec3<F> b) { return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; }
template <class F> MONTELUX_INLINE Vec3<F> max(Vec3<F> a, Vec3<F> b) { return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; }
template <class F> MONTELUX_INLINE Vec2<F> select(Mask<F> m, Vec2<F> a, Vec2<F> b) { return {select(m, a.x, b.x), select(m, a.y, b.y)}; }
template <class F> MONTELUX_INLINE Vec3<F> select(Mask<F> m, Vec3<F> a, Vec3<F> b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
// n or -n, whichever lies in the hemisphere of v.
template <class F> MONTELUX_INLINE Vec3<F> face_forward(Vec3<F> n, Vec3<F> v) { return n * copysign(F(1.0f), dot(n, v)); }
// The mirror image of w about n (both unit).
template <class F> MONTELUX_INLINE Vec3<F> reflect(Vec3<F> w, Vec3<F> n) { return n * (2.0f * dot(w, n)) - w; }

template <class F> MONTELUX_INLINE Vec3<F> splat(Vec3f a) { return {F(a.x), F(a.y), F(a.z)}; }
template <class F> MONTELUX_INLINE Vec2f lane(const Vec2<F>& a, int k) { return {lane(a.x, k), lane(a.y, k)}; }
template <class F> MONTELUX_INLINE Vec3f lane(const Vec3<F>& a, int k) { return {lane(a.x, k), lane(a.y, k), lane(a.z, k)}; }
template <class F> MONTELUX_INLINE void set_lane(Vec2<F>& a, int k, Vec2f b) { set_lane(a.x, k, b.x), set_lane(a.y, k, b.y); }
template <class F> MONTELUX_INLINE void set_lane(Vec3<F>& a, int k, Vec3f b) {
  set_lane(a.x, k, b.x), set_lane(a.y, k, b.y), set_lane(a.z, k, b.z);
}
// Three consecutive floats at base + i.
template <class F> MONTELUX_INLINE Vec3<F> gather3(const float* base, Uint<F> i) {
  return {gather(base, i), gather(base + 1, i), gather(base + 2, i)};
}
template <class F> MONTELUX_INLINE Vec2<F> gather2(const float* base, Uint<F> i) { return {gather(base, i), gather(base + 1, i)}; }
// clang-format on

// A right-handed orthonormal frame (tangent, bitangent, normal).
template <class F>
struct LocalFrame {
  Vec3<F> s, t, n;

  // Any frame around the unit vector n, without a branch (Duff et al. 2017, "Building an Orthonormal Basis,
  // Revisited").
  static MONTELUX_INLINE LocalFrame from_normal(Vec3<F> n) {
    F sign = copysign(F(1.0f), n.z);
    F a = F(-1.0f) / (sign + n.z);
    F b = n.x * n.y * a;
    return {{F(1.0f) + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }
  // The frame around unit n whose s is the direction nearest to `tangent`; any frame where tangent is parallel to n.
  static MONTELUX_INLINE LocalFrame from_normal_tangent(Vec3<F> n, Vec3<F> tangent) {
    Vec3<F> s = tangent - n * dot(n, tangent);
    F squared = dot(s, s);
    LocalFrame any_frame = from_normal(n);
    Mask<F> good = squared > F(1e-12f) * dot(tangent, tangent);
    s = select(good, s * (F(1.0f) / sqrt(max(squared, F(1e-30f)))), any_frame.s);
    return {s, cross(n, s), n};
  }
  MONTELUX_INLINE Vec3<F> to_local(Vec3<F> v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  MONTELUX_INLINE Vec3<F> to_world(Vec3<F> v) const { return s * v.x + t * v.y + n * v.z; }
};

}  // namespace montelux
