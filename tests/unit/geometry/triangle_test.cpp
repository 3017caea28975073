#include "geometry/triangle.h"

#include <gtest/gtest.h>

#include "geometry_samples.h"

namespace montelux {
namespace {

using F = NativeFloats;
using test::random_direction;
using test::Stream;
using test::uniform;

TriangleCorners<float> random_triangle(Stream& r, float scale) {
  const Vec3f aside = random_direction(r);
  Vec3f shift = aside * (scale * uniform(r, 0, 100));
  auto corner = [&] { return random_direction(r) * scale + shift; };
  Vec3f a = corner(), b = corner(), c = corner();
  return {a, b, c, r.next2(), r.next2(), r.next2()};
}

TriangleNormals<float> random_normals(Stream& r, bool present) {
  return {random_direction(r), random_direction(r), random_direction(r), present};
}

TEST(Triangle, a_lane_has_the_bits_of_a_float) {
  Stream r(1, 1);
  for (int i = 0; i < 200; ++i) {
    TriangleCorners<F> c;
    TriangleNormals<F> n;
    F u, v;
    std::uint32_t present = r.bits_at(std::uint32_t(i)), flip = r.bits_at(std::uint32_t(i + 1000));
    std::vector<SurfacePoint<float>> truth;
    for (int k = 0; k < native_lanes; ++k) {
      TriangleCorners<float> ck = random_triangle(r, std::pow(10.0f, uniform(r, -6, 6)));
      TriangleNormals<float> nk = random_normals(r, present >> k & 1);
      if (k % 5 == 4) ck.uv1 = ck.uv0;
      float uk = r.next(), vk = (1 - uk) * r.next();
      set_lane(c.p0, k, ck.p0), set_lane(c.p1, k, ck.p1), set_lane(c.p2, k, ck.p2);
      set_lane(c.uv0, k, ck.uv0), set_lane(c.uv1, k, ck.uv1), set_lane(c.uv2, k, ck.uv2);
      set_lane(n.n0, k, nk.n0), set_lane(n.n1, k, nk.n1), set_lane(n.n2, k, nk.n2);
      set_lane(u, k, uk), set_lane(v, k, vk);
      truth.push_back(triangle_point<float>(ck, nk, flip >> k & 1, uk, vk));
    }
    std::uint32_t used = native_lanes == 32 ? ~0u : (1u << native_lanes) - 1u;
    n.present = mask_of_bits<F>(present & used);
    SurfacePoint<F> s = triangle_point<F>(c, n, mask_of_bits<F>(flip & used), u, v);
    for (int k = 0; k < native_lanes; ++k) {
      auto same = [&](Vec3f a, Vec3f b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
      ASSERT_TRUE(same(lane(s.p, k), truth[k].p) && same(lane(s.p_error, k), truth[k].p_error));
      ASSERT_TRUE(same(lane(s.ng, k), truth[k].ng) && same(lane(s.ns, k), truth[k].ns));
      ASSERT_TRUE(same(lane(s.dpdu, k), truth[k].dpdu));
      ASSERT_EQ(lane(s.uv, k).x, truth[k].uv.x);
    }
  }
}

TEST(Triangle, rays_that_leave_start_on_their_side_of_the_plane) {
  Stream r(2, 2);
  for (int i = 0; i < 100000; ++i) {
    TriangleCorners<float> c = random_triangle(r, std::pow(10.0f, uniform(r, -6, 6)));
    float u = r.next(), v = (1 - u) * r.next();
    SurfacePoint<float> s = triangle_point<float>(c, random_normals(r, false), false, u, v);
    Vec3f w = random_direction(r);
    Vec3d a = to_double(c.p0), n = unit(cross(to_double(c.p1) - a, to_double(c.p2) - a));
    // A sliver's normal in single precision is its own rounding; its plane is tested where it has one.
    if (dot(n, to_double(s.ng)) < 0.99999 || abs_dot(s.ng, w) < 1e-3f) continue;
    double distance = dot(to_double(offset_origin(s.p, s.p_error, s.ng, w)) - a, n);
    ASSERT_GT(distance * dot(n, to_double(w)), 0) << c.p0.x;
    ASSERT_LT(std::abs(distance), 1e-3 * (norm(a) + length(c.p1 - c.p0)));
  }
}

TEST(Triangle, error_bound_holds_in_comparison_with_double_precision) {
  Stream r(3, 3);
  for (int i = 0; i < 100000; ++i) {
    TriangleCorners<float> c = random_triangle(r, 1);
    float u = r.next(), v = (1 - u) * r.next();
    SurfacePoint<float> s = triangle_point<float>(c, random_normals(r, false), false, u, v);
    Vec3d p = to_double(c.p0) * (1 - double(u) - v) + to_double(c.p1) * u + to_double(c.p2) * v;
    Vec3d error = abs_of(p - to_double(s.p));
    ASSERT_LE(error.x, s.p_error.x);
    ASSERT_LE(error.y, s.p_error.y);
    ASSERT_LE(error.z, s.p_error.z);
  }
}

TEST(Triangle, orientation_follows_normals_first_and_the_flip_else) {
  TriangleCorners<float> c{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  TriangleNormals<float> none{{}, {}, {}, false}, down{{0, 0, -1}, {0, 0, -2}, {0, 1, -1}, true};
  EXPECT_EQ(triangle_point<float>(c, none, false, 0.25f, 0.25f).ng.z, 1);
  EXPECT_EQ(triangle_point<float>(c, none, true, 0.25f, 0.25f).ng.z, -1);
  EXPECT_EQ(triangle_point<float>(c, none, true, 0.25f, 0.25f).ns.z, -1);
  EXPECT_EQ(triangle_point<float>(c, down, false, 0.25f, 0.25f).ng.z, -1);
  EXPECT_LT(triangle_point<float>(c, down, false, 0.25f, 0.25f).ns.z, -0.9f);
  TriangleNormals<float> cancelling{{0, 0, 1}, {0, 0, -1}, {0, 0, 0}, true};
  EXPECT_EQ(triangle_point<float>(c, cancelling, false, 0.5f, 0.0f).ns.z, 1);
}

TEST(Triangle, tangent_inverts_the_texture_map) {
  Stream r(4, 4);
  for (int i = 0; i < 1000; ++i) {
    // p = p0 + s a + t b at texture coordinates (s, t): dp/ds = a.
    Vec3f a = random_direction(r), b = random_direction(r), p0 = random_direction(r);
    TriangleCorners<float> c;
    c.uv0 = r.next2(), c.uv1 = r.next2(), c.uv2 = r.next2();
    auto at = [&](Vec2f t) { return p0 + a * t.x + b * t.y; };
    c.p0 = at(c.uv0), c.p1 = at(c.uv1), c.p2 = at(c.uv2);
    Vec2f d1 = c.uv1 - c.uv0, d2 = c.uv2 - c.uv0;
    if (std::abs(d1.x * d2.y - d1.y * d2.x) < 0.05f) continue;
    EXPECT_LT(length(triangle_point<float>(c, random_normals(r, false), false, 0.3f, 0.3f).dpdu - a), 2e-5f);
  }
  TriangleCorners<float> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}};
  Vec3f any = triangle_point<float>(flat, {{}, {}, {}, false}, false, 0.3f, 0.3f).dpdu;
  EXPECT_NEAR(length(any), 1, 1e-6);
  EXPECT_NEAR(any.z, 0, 1e-6);
}

}  // namespace
}  // namespace montelux
