#include "geometry/curve.h"

#include <gtest/gtest.h>

#include "geometry_samples.h"

namespace montelux {
namespace {

using test::random_direction;
using test::Stream;

constexpr float infinity = std::numeric_limits<float>::infinity();

std::vector<Vec3f> random_points(Stream& r, int n) {
  std::vector<Vec3f> p;
  for (int i = 0; i < n; ++i) p.push_back(random_direction(r) * 2.0f);
  return p;
}

// By the Bernstein polynomials.
Vec3d bezier(const CurveSet& c, std::uint32_t segment, double u) {
  const CurveControl* k = &c.controls[c.first[segment]];
  auto p = [&](int i) { return Vec3d{k[i].x, k[i].y, k[i].z}; };
  double w = 1 - u;
  return p(0) * (w * w * w) + p(1) * (3 * w * w * u) + p(2) * (3 * w * u * u) + p(3) * (u * u * u);
}

TEST(Curve, raising_a_quadratic_bezier_keeps_every_point) {
  Stream r(1, 1);
  CurveDesc desc{random_points(r, 7)};
  desc.degree = 2;
  CurveSet c = make_curves(desc).value();
  ASSERT_EQ(c.first.size(), 3u);
  for (std::uint32_t s = 0; s < 3; ++s)
    for (double u = 0; u <= 1; u += 0.125) {
      const Vec3f* p = &desc.points[2 * s];
      Vec3d truth =
          to_double(p[0]) * ((1 - u) * (1 - u)) + to_double(p[1]) * (2 * u * (1 - u)) + to_double(p[2]) * (u * u);
      EXPECT_LT(norm(bezier(c, s, u) - truth), 5e-7);
    }
}

TEST(Curve, b_splines_become_the_same_curve) {
  Stream r(2, 2);
  for (int degree : {2, 3}) {
    CurveDesc desc{random_points(r, 7), CurveBasis::bspline, degree};
    CurveSet c = make_curves(desc).value();
    ASSERT_EQ(c.first.size(), std::size_t(7 - degree));
    for (std::uint32_t s = 0; s < c.first.size(); ++s)
      for (double u = 0; u <= 1; u += 0.125) {
        // The uniform B-spline's basis functions on one knot interval.
        double w = 1 - u;
        std::array<double, 4> b{w * w / 2, 0.5 + u * w, u * u / 2, 0};
        if (degree == 3)
          b = {w * w * w / 6, (3 * u * u * u - 6 * u * u + 4) / 6, (3 * w * w * w - 6 * w * w + 4) / 6, u * u * u / 6};
        Vec3d truth{0, 0, 0};
        for (std::size_t k = 0; k <= std::size_t(degree); ++k) truth += to_double(desc.points[s + k]) * b[k];
        EXPECT_LT(norm(bezier(c, s, u) - truth), 1e-6) << degree;
      }
  }
}

TEST(Curve, width_runs_linearly_over_all_segments) {
  Stream r(3, 3);
  CurveDesc desc{random_points(r, 7)};
  desc.width0 = 0.2f, desc.width1 = 0.8f;
  CurveSet c = to_world(make_curves(desc).value(), scale(10, 10, 10), false);
  ASSERT_EQ(c.controls.size(), 8u);
  EXPECT_NEAR(c.controls[0].radius, 1, 1e-6);
  EXPECT_NEAR(c.controls[3].radius, 2.5, 1e-6);
  EXPECT_NEAR(c.controls[4].radius, 2.5, 1e-6);
  EXPECT_NEAR(c.controls[5].radius, 3, 1e-6);
  EXPECT_NEAR(c.controls[7].radius, 4, 1e-6);
}

TEST(Curve, descriptions_without_whole_segments_fail_with_a_message) {
  CurveDesc desc;
  desc.points.resize(6);
  EXPECT_FALSE(make_curves(desc));
  desc.degree = 4;
  EXPECT_FALSE(make_curves(desc));
  desc.degree = 3, desc.basis = CurveBasis::bspline;
  EXPECT_TRUE(make_curves(desc));
  desc.type = CurveType::ribbon, desc.normals.resize(3);
  EXPECT_FALSE(make_curves(desc));
  EXPECT_NE(make_curves(desc).error().find("normal"), std::string::npos);
  desc.normals.resize(4);
  EXPECT_TRUE(make_curves(desc));
}

CurveDesc straight(CurveType type) {
  CurveDesc d{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}};
  d.type = type, d.width0 = d.width1 = 0.4f;
  if (type == CurveType::ribbon) d.normals = {{0, 0, 1}, {0, 0, 1}};
  return d;
}

TEST(Curve, flat_normals_face_the_ray_and_v_runs_across) {
  CurveSet c = make_curves(straight(CurveType::flat)).value();
  // Seen along -z, the direction across is -z x +x = -y.
  Ray<float> ray{{1.5f, -0.1f, 5}, {0, 0, -2}, infinity};
  SurfacePoint<float> q = curve_point(c, 0, 0.5f, ray, 2.5f);
  EXPECT_NEAR(q.ng.z, 1, 1e-6);
  EXPECT_NEAR(q.dpdu.x, 3, 1e-6);
  EXPECT_NEAR(q.uv.y, 0.75, 1e-6);
  EXPECT_LT(length(q.p - Vec3f{1.5f, -0.1f, 0}), 1e-6f);
  EXPECT_NEAR(q.p_error.x, 0.4, 1e-6);
  ray = {{1.5f, -0.1f, -5}, {0, 0, 2}, infinity};
  q = curve_point(c, 0, 0.5f, ray, 2.5f);
  EXPECT_NEAR(q.ng.z, -1, 1e-6);
  EXPECT_NEAR(q.uv.y, 0.25, 1e-6);
}

TEST(Curve, cylinder_normals_turn_outward_across_the_band) {
  CurveSet c = make_curves(straight(CurveType::cylinder)).value();
  for (float y : {-0.2f, -0.1f, 0.0f, 0.1f, 0.2f}) {
    SurfacePoint<float> q = curve_point(c, 0, 0.5f, {{1.5f, y, 5}, {0, 0, -1}, infinity}, 5);
    double angle = y / 0.4 * std::numbers::pi;
    EXPECT_NEAR(q.ng.y, std::sin(angle), 1e-5);
    EXPECT_NEAR(q.ng.z, std::cos(angle), 1e-5);
    EXPECT_NEAR(q.ng.x, 0, 1e-6);
  }
}

TEST(Curve, ribbon_normals_are_those_stated) {
  CurveSet c = make_curves(straight(CurveType::ribbon)).value();
  Ray<float> from_above{{1.5f, 0.1f, 5}, {0, 0.1f, -1}, infinity}, from_below{{1.5f, 0.1f, -5}, {0, 0, 1}, infinity};
  EXPECT_NEAR(curve_point(c, 0, 0.5f, from_above, 5).ng.z, 1, 1e-6);
  EXPECT_NEAR(curve_point(c, 0, 0.5f, from_below, 5).ng.z, 1, 1e-6);
  EXPECT_NEAR(curve_point(c, 0, 0.5f, from_below, 5).uv.y, 0.75, 1e-6);
  EXPECT_NEAR(curve_point(to_world(c, {}, true), 0, 0.5f, from_below, 5).ng.z, -1, 1e-6);
}

TEST(Curve, appended_sets_keep_their_segments) {
  Stream r(4, 4);
  CurveSet a = make_curves({random_points(r, 4)}).value(), b = make_curves({random_points(r, 7)}).value(), both = a;
  append(both, b);
  ASSERT_EQ(both.first.size(), 3u);
  EXPECT_LT(norm(bezier(both, 2, 0.3) - bezier(b, 1, 0.3)), 1e-12);
}

}  // namespace
}  // namespace montelux
