#include "geometry/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry_samples.h"

namespace montelux {
namespace {

using test::NamedShape;
using test::random_direction;
using test::shapes_at;
using test::Stream;
using test::uniform;

constexpr float infinity = std::numeric_limits<float>::infinity();

Vec3d at(const Ray<float>& ray, double t) { return to_double(ray.o) + to_double(ray.d) * t; }

// A ray toward a point of the shape from a few sizes away, with a direction that is not unit.
Ray<float> ray_toward(const Vec3f& target, float size, Stream& r) {
  const Vec3f direction = random_direction(r);
  Vec3f o = target + direction * (size * uniform(r, 0.5f, 8));
  return {o, (target - o) * uniform(r, 0.1f, 3), infinity};
}

// The nearest hit with the shape cut into flat triangles, in double precision (Moeller and Trumbore 1997).
std::optional<double> hit_tessellation(const std::vector<Vec3d>& grid, int n, const Ray<float>& ray) {
  Vec3d o = to_double(ray.o), d = to_double(ray.d);
  std::optional<double> best;
  auto triangle = [&](Vec3d a, Vec3d b, Vec3d c) {
    Vec3d e1 = b - a, e2 = c - a, p = cross(d, e2), s = o - a, q = cross(s, e1);
    double det = dot(e1, p);
    if (det == 0) return;
    double u = dot(s, p) / det, v = dot(d, q) / det, t = dot(e2, q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && t > 0 && (!best || t < *best)) best = t;
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Vec3d &a = grid[j * (n + 1) + i], &b = grid[j * (n + 1) + i + 1], &c = grid[(j + 1) * (n + 1) + i],
                  &e = grid[(j + 1) * (n + 1) + i + 1];
      triangle(a, b, e);
      triangle(a, e, c);
    }
  return best;
}

TEST(Shape, a_ray_toward_a_point_of_it_meets_it_there_or_before_at_every_scale) {
  Stream r(1, 2);
  for (float s : {1e-4f, 1e-2f, 1.0f, 1e3f, 1e6f})
    for (const NamedShape& k : shapes_at(s))
      for (int i = 0; i < 500; ++i) {
        // Away from the border, which a ray in single precision may miss.
        Vec2f uv{uniform(r, 0.01f, 0.99f), uniform(r, 0.01f, 0.99f)};
        Vec3f target = surface_point(k.shape, uv).p;
        Ray<float> ray = ray_toward(target, k.size, r);
        // A ray along the surface may just miss it, or meet it elsewhere.
        const double cos = std::abs(double(dot(surface_point(k.shape, uv).ng, normalize(ray.d))));
        bool grazing = cos < 0.02;
        auto hit = intersect(k.shape, ray, 0);
        if (grazing && !hit) continue;
        ASSERT_TRUE(hit) << k.name << " at scale " << s;
        Vec3d d = to_double(ray.d);
        double reach = dot(to_double(target) - to_double(ray.o), d) / dot(d, d);
        if (!grazing) {
          // How far the rounded target is off the surface, seen along the ray.
          ASSERT_LE(hit->t, reach + (1e-5 + 1e-6 / cos) * k.size / norm(d)) << k.name;
        }
        for (const SurfacePoint<float>& q : {surface_point(k.shape, ray, *hit), surface_point(k.shape, hit->uv)}) {
          ASSERT_LT(norm(to_double(q.p) - at(ray, hit->t)), 1e-5 * k.size) << k.name << " at scale " << s;
          ASSERT_NEAR(length(q.ng), 1, 1e-6);
          ASSERT_NEAR(dot(q.ng, q.dpdu) / length(q.dpdu), 0, 1e-5) << k.name;
        }
      }
}

TEST(Shape, no_hit_lies_outside_the_ray_and_every_hit_lies_in_the_bounds) {
  Stream r(3, 4);
  for (float s : {1e-4f, 1.0f, 1e6f})
    for (const NamedShape& k : shapes_at(s)) {
      Bounds3 box = bounds(k.shape);
      const Ball ball = ball_around(k.shape);
      for (int i = 0; i < 1000; ++i) {
        SurfacePoint<float> q = surface_point(k.shape, r.next2());
        ASSERT_TRUE(box.contains(q.p)) << k.name;
        ASSERT_LE(norm(to_double(q.p) - to_double(ball.centre)), ball.radius) << k.name;
        Ray<float> ray = ray_toward(q.p, k.size, r);
        auto hit = intersect(k.shape, ray, 0);
        if (!hit) continue;
        ray.t_max = hit->t;
        EXPECT_FALSE(intersect(k.shape, ray, 0)) << k.name;
        ray.t_max = infinity;
        auto later = intersect(k.shape, ray, hit->t);
        if (later) {
          EXPECT_GT(later->t, hit->t) << k.name;
        }
      }
    }
}

TEST(Shape, the_ball_around_a_sphere_that_stays_round_is_hardly_wider) {
  for (const Transform& m : {translate(3, -2, 5), rotate(40, 1, 2, 3) * scale(0.1, -0.1, 0.1), translate(0, 1e3, 0)}) {
    const Ball ball = ball_around(Sphere{m, false, 2, -2, 2, 360});
    const double radius = norm(transform_direction(m.matrix(), {2, 0, 0})), away = norm(to_double(ball.centre));
    EXPECT_GT(ball.radius, radius);
    EXPECT_LT(ball.radius, radius * (1 + 1e-5) + away * 1e-6);
  }
}

TEST(Shape, hits_agree_with_a_dense_tessellation) {
  Stream r(5, 6);
  const int n = 96;
  for (const NamedShape& k : shapes_at(1)) {
    std::vector<Vec3d> grid;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) grid.push_back(to_double(surface_point(k.shape, {float(i) / n, float(j) / n}).p));
    int differ = 0, hits = 0;
    for (int i = 0; i < 150; ++i) {
      Bounds3 box = bounds(k.shape);
      Vec3f target{uniform(r, box.low.x, box.high.x), uniform(r, box.low.y, box.high.y),
                   uniform(r, box.low.z, box.high.z)};
      Ray<float> ray = ray_toward(target, 1, r);
      auto hit = intersect(k.shape, ray, 0);
      auto flat = hit_tessellation(grid, n, ray);
      hits += flat.has_value();
      // The triangles leave the surface by about (2 pi / n)^2 / 8 = 5e-4, more along the ray where it grazes.
      bool same = hit.has_value() == flat.has_value() && (!hit || norm(at(ray, hit->t) - at(ray, *flat)) < 0.01);
      differ += !same;
    }
    EXPECT_LE(differ, 4) << k.name;
    EXPECT_GT(hits, 20) << k.name;
  }
}

TEST(Shape, sphere_hits_match_the_closed_form) {
  Stream r(7, 8);
  for (float s : {1e-4f, 1.0f, 1e6f}) {
    Sphere ball{translate(3 * s, 0, 0), false, s, -s, s, 360};
    for (int i = 0; i < 1000; ++i) {
      // Seen from distance d at angle a: t = d cos a - sqrt(r^2 - d^2 sin^2 a).
      const Vec3f away = random_direction(r);
      Vec3f o = Vec3f{3 * s, 0, 0} + away * (s * uniform(r, 1.5f, 100));
      Vec3d to_center = Vec3d{double(3 * s), 0, 0} - to_double(o);
      Vec3d aim = to_center + to_double(random_direction(r)) * (0.95 * s);
      Ray<float> ray{o, to_float(unit(aim)), infinity};
      double d = norm(to_center), c = dot(to_center, unit(to_double(ray.d))) / d;
      double truth = d * c - std::sqrt(s * double(s) - d * d * (1 - c * c));
      auto hit = intersect(ball, ray, 0);
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->t / truth, 1, 3e-7);
    }
  }
}

TEST(Shape, closed_surfaces_let_no_ray_out) {
  Stream r(9, 10);
  // A cube of bilinear patches whose corners are shifted: neighbours share straight edges.
  std::array<Vec3f, 8> corner;
  for (int i = 0; i < 8; ++i)
    corner[i] =
        Vec3f{float(i & 1), float(i >> 1 & 1), float(i >> 2)} * 2.0f - Vec3f{1, 1, 1} + random_direction(r) * 0.4f;
  auto face = [&](int a, int b, int c, int d) {
    BilinearPatch q;
    q.p = {corner[a], corner[b], corner[c], corner[d]};
    return q;
  };
  std::array<BilinearPatch, 6> box{face(0, 1, 2, 3), face(4, 5, 6, 7), face(0, 1, 4, 5),
                                   face(2, 3, 6, 7), face(0, 2, 4, 6), face(1, 3, 5, 7)};
  Sphere ball{scale(1, 0.01, 3), false, 1, -1, 1, 360};
  for (int i = 0; i < 100000; ++i) {
    // Some rays aim at an edge exactly as well as single precision can.
    Vec3f d = random_direction(r);
    if (i % 2) d = corner[i / 2 % 4] + (corner[i / 2 % 4 + 4] - corner[i / 2 % 4]) * r.next();
    bool out = true;
    for (const BilinearPatch& q : box) out = out && !intersect(q, {{0, 0, 0}, d, infinity}, 0);
    ASSERT_FALSE(out) << i;
    ASSERT_TRUE(intersect(ball, {{0.1f, 0, 0.3f}, d, infinity}, 0)) << i;
  }
}

TEST(Shape, rays_that_leave_do_not_meet_the_surface_again) {
  Stream r(11, 12);
  for (int i = 0; i < 20000; ++i) {
    float s = std::pow(10.0f, uniform(r, -6, 6));
    const float x = uniform(r, -50, 50), y = uniform(r, -50, 50), turn = r.next() * 360;
    Transform place = translate(s * x, s * y, 0) * rotate(turn, 1, 2, 3) * scale(s, s, s);
    for (const Shape& shape : {Shape(Sphere{place, false, 1, -1, 1, 360}), Shape(Disk{place, false, 0, 1, 0, 360})}) {
      SurfacePoint<float> q = surface_point(shape, r.next2());
      Vec3f w = random_direction(r);
      bool ball = std::holds_alternative<Sphere>(shape);
      float c = dot(q.ng, w);
      auto hit = intersect(shape, {offset_origin(q.p, q.p_error, q.ng, w), w, infinity}, 0);
      if (!ball || c > 0) {
        ASSERT_FALSE(hit) << "scale " << s << " cos " << c;
      } else if (c < -0.05f) {
        // Inside a sphere the ray crosses to the other side, along a chord.
        ASSERT_TRUE(hit);
        // The place is rounded to about 1e-5 of the radius, as it is 80 radii from the origin; a flat chord stretches
        // that.
        ASSERT_NEAR(hit->t / s, -2 * c, 4e-5 / -c);
      }
    }
  }
}

TEST(BilinearPatch, rays_that_leave_do_not_meet_the_patch_again) {
  // Flat patches that no parallelogram covers, one in a coordinate plane, and a curved one.
  const std::array<Vec3f, 4> flat{Vec3f{552.8f, 0, 0}, Vec3f{0, 0, 0}, Vec3f{549.6f, 0, 559.2f}, Vec3f{0, 0, 559.2f}};
  const std::array<Vec3f, 4> tilted{Vec3f{552.8f, 3, 0}, Vec3f{0, 1, 0}, Vec3f{549.6f, 8, 559.2f}, Vec3f{0, 6, 559.2f}};
  for (const auto& corners : {flat, tilted}) {
    BilinearPatch patch;
    patch.p = corners;
    std::uint32_t again = 0, hits = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      RandomStream<float> random(i, 7u);
      Vec3f o{200 + 200 * random.next(), 273, 200 + 200 * random.next()};
      Vec3f target{548 * random.next(), 4, 558 * random.next()};
      Ray<float> ray{o, normalize(target - o), 1e30f};
      auto hit = intersect(patch, ray, 0);
      if (!hit) continue;
      ++hits;
      SurfacePoint<float> s = surface_point(patch, ray, *hit);
      Vec3f up = face_forward(s.ng, -ray.d);
      const float rise = 0.01f + random.next(), side = random.next() - 0.5f;
      Vec3f w = normalize(up * rise + LocalFrame<float>::from_normal(up).s * side);
      if (intersect(patch, {offset_origin(s.p, s.p_error, s.ng, w), w, 1e30f}, 0)) ++again;
    }
    EXPECT_GT(hits, 15000u);
    EXPECT_EQ(again, 0u);
  }
}

// Rays toward the shape, beside it, away from it, along it, and some that end before it.
TEST(Shape, several_rays_hit_what_each_of_them_hits_alone) {
  Stream r(31, 17);
  for (const NamedShape& k : shapes_at(2)) {
    for (std::size_t count : {1, 2, 7, 8, 9, 16}) {
      std::size_t met = 0;
      for (int round = 0; round < 200; ++round) {
        std::vector<Ray<float>> rays;
        for (std::size_t i = 0; i < count; ++i) {
          const SurfacePoint<float> s = surface_point(k.shape, r.next2());
          Ray<float> ray = ray_toward(s.p, k.size, r);
          if (const float kind = r.next(); kind < 0.2f)
            ray.d = random_direction(r);
          else if (kind < 0.4f)
            ray.o = offset_origin(s.p, s.p_error, s.ng, ray.d);
          else if (kind < 0.5f)
            ray.t_max = uniform(r, 0, 2) * length(s.p - ray.o) / length(ray.d);
          else if (kind < 0.6f)
            ray.o = s.p - s.dpdu * 2.0f, ray.d = s.dpdu;
          rays.push_back(ray);
        }
        std::vector<std::optional<ShapeHit>> hits(count, ShapeHit{-1, {-1, -1}});
        intersect(k.shape, rays, hits);
        for (std::size_t i = 0; i < count; ++i) {
          const std::optional<ShapeHit> alone = intersect(k.shape, rays[i], 0);
          ASSERT_EQ(hits[i].has_value(), alone.has_value()) << k.name;
          if (!alone) continue;
          ++met;
          ASSERT_EQ(hits[i]->t, alone->t) << k.name;
          ASSERT_EQ(hits[i]->uv.x, alone->uv.x) << k.name;
          ASSERT_EQ(hits[i]->uv.y, alone->uv.y) << k.name;
        }
      }
      EXPECT_GT(met, 40 * count) << k.name;
      EXPECT_LT(met, 190 * count) << k.name;
    }
  }
}

TEST(Shape, rays_that_leave_a_far_point_of_a_huge_sphere_keep_off_it) {
  Stream r(13, 14);
  Sphere ground{translate(0, -1e6, 0) * rotate(90, 1, 0, 0), false, 1e6f, -1e6f, 1e6f, 360};
  for (int i = 0; i < 20000; ++i) {
    Ray<float> ray{{uniform(r, -5, 5), uniform(r, 0.5f, 5), uniform(r, -5, 5)}, random_direction(r), infinity};
    ray.d.y = -0.05f - abs(ray.d.y);
    auto hit = intersect(ground, ray, 0);
    ASSERT_TRUE(hit);
    SurfacePoint<float> q = surface_point(ground, ray, *hit);
    ASSERT_LT(norm(to_double(q.p) - at(ray, hit->t)), 1e-4);
    Vec3f w = random_direction(r);
    w.y = abs(w.y);
    auto again = intersect(ground, {offset_origin(q.p, q.p_error, q.ng, w), w, infinity}, 0);
    ASSERT_FALSE(again && dot(w, q.ng) > 0) << w.y;
  }
}

TEST(Shape, normals_point_outward_unless_reversed_or_mirrored) {
  Transform none, mirror = scale(1, 1, -1);
  for (const Transform& m : {none, mirror})
    for (bool reverse : {false, true}) {
      float side = (reverse != m.swaps_handedness()) ? -1.0f : 1.0f;
      SurfacePoint<float> q = surface_point(Sphere{m, reverse, 1, -1, 1, 360}, Vec2f{0.3f, 0.4f});
      EXPECT_NEAR(dot(q.ng, q.p), side, 1e-6);
      q = surface_point(Cylinder{m, reverse, 1, -1, 1, 360}, Vec2f{0, 0.4f});
      EXPECT_NEAR(q.ng.x, side, 1e-6);
      q = surface_point(Disk{m, reverse, 0, 1, 0, 360}, Vec2f{0, 0.4f});
      EXPECT_NEAR(q.ng.z, m.swaps_handedness() ? -side : side, 1e-6);
    }
}

TEST(Shape, parameters_follow_their_definition) {
  Sphere ball{{}, false, 2, -2, 2, 360};
  auto hit = intersect(ball, {{0, 0, 5}, {0, 0.0001f, -1}, infinity}, 0);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->uv.x, 0.25, 1e-6);  // toward +y
  EXPECT_NEAR(hit->uv.y, 1, 1e-3);     // v grows with z
  Disk disk{{}, false, 1, 2, 1, 180};
  hit = intersect(disk, {{0, 1.5f, 0}, {0, 0, 2}, infinity}, 0);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, 0.5f);
  EXPECT_NEAR(hit->uv.x, 0.5, 1e-6);
  EXPECT_NEAR(hit->uv.y, 0.5, 1e-6);
  EXPECT_FALSE(intersect(disk, {{0, -1.5f, 0}, {0, 0, 2}, infinity}, 0));  // beyond phi_max
  EXPECT_FALSE(intersect(disk, {{0, 0.5f, 0}, {0, 0, 2}, infinity}, 0));   // in the hole
  Sphere limits = clamped(Sphere{{}, false, 1, 3, -0.5f, 400});
  EXPECT_EQ(limits.z_min, -0.5f);
  EXPECT_EQ(limits.z_max, 1);
  EXPECT_EQ(limits.phi_max, 360);
}

// The angles of the point that is hit, by the standard library in double precision. The shapes are whole, so that their
// parameters are computed in single precision.
TEST(Shape, parameters_of_whole_shapes_are_angles_to_single_precision) {
  constexpr double pi = std::numbers::pi;
  const Sphere ball{{}, false, 2, -2, 2, 360};
  const Cylinder tube{{}, false, 2, -3, 3, 360};
  const Disk plate{{}, false, 0, 2, 0, 360};
  Stream r(41, 42);
  double largest_u = 0, largest_v = 0;
  int hits = 0, wrong_if_reversed = 0;
  for (int i = 0; i < 8000; ++i) {
    const Ray<float> ray{{uniform(r, -4, 4), uniform(r, -4, 4), uniform(r, -4, 4)}, random_direction(r), infinity};
    const auto compare = [&](const Shape& shape, auto v_of) {
      const auto hit = intersect(shape, ray, 0);
      if (!hit) return;
      const Vec3d p = at(ray, hit->t);
      const double across = std::hypot(p.x, p.y);
      // Where a rounded distance hardly turns the azimuth.
      if (across < 0.5) return;
      const double turns = std::atan2(p.y, p.x) / (2 * pi), u = turns < 0 ? turns + 1 : turns;
      const double off = std::abs(hit->uv.x - u);
      largest_u = std::max(largest_u, std::min(off, 1 - off));
      const double v = v_of(p, across);
      largest_v = std::max(largest_v, std::abs(hit->uv.y - v));
      ++hits, wrong_if_reversed += std::abs(1 - hit->uv.x - u) > 1e-4 && std::abs(1 - hit->uv.y - v) > 1e-4;
    };
    compare(ball, [&](const Vec3d& p, double across) { return 1 - std::atan2(across, p.z) / pi; });
    compare(tube, [](const Vec3d& p, double) { return (p.z + 3) / 6; });
    compare(plate, [](const Vec3d&, double across) { return (2 - across) / 2; });
  }
  EXPECT_GT(hits, 2000);
  EXPECT_LT(largest_u, 1e-6);
  EXPECT_LT(largest_v, 1e-6);
  EXPECT_GT(wrong_if_reversed, 0.99 * hits);
}

TEST(Shape, bilinear_texture_coordinates_and_tangents_follow_the_corners) {
  BilinearPatch q = test::twisted_patch(1);
  SurfacePoint<float> plain = surface_point(q, Vec2f{0.25f, 0.75f});
  for (Vec2f& t : q.uv) t = {3 * t.y, 2 * t.x};
  SurfacePoint<float> mapped = surface_point(q, Vec2f{0.25f, 0.75f});
  EXPECT_NEAR(mapped.uv.x, 2.25, 1e-6);
  EXPECT_NEAR(mapped.uv.y, 0.5, 1e-6);
  // s = 3 v: dp/ds = (dp/dv) / 3, by a central difference of the position.
  Vec3f difference = (surface_point(q, Vec2f{0.25f, 0.875f}).p - surface_point(q, Vec2f{0.25f, 0.625f}).p) * (4.0f / 3);
  EXPECT_LT(length(mapped.dpdu - difference), 1e-5);
  EXPECT_LT(length(plain.ng - mapped.ng), 1e-6);
  q.normals = {-plain.ng, -plain.ng, -plain.ng, -plain.ng};
  EXPECT_LT(dot(surface_point(q, Vec2f{0.25f, 0.75f}).ng, plain.ng), -0.9f);
}

TEST(Shape, areas_match_closed_forms) {
  const double pi_d = std::numbers::pi;
  for (double s : {1e-4, 1.0, 1e6}) {
    Transform m = rotate(30, 1, 1, 0) * scale(s, s, -s);
    EXPECT_NEAR(area(Sphere{m, false, 2, -2, 2, 360}) / (16 * pi_d * s * s), 1, 1e-9);
    EXPECT_NEAR(area(Sphere{m, false, 2, -1, 1.5f, 90}) / (2.5 * pi_d * s * s), 1, 1e-9);
    EXPECT_NEAR(area(Cylinder{m, false, 2, -1, 1.5f, 90}) / (2.5 * pi_d * s * s), 1, 1e-9);
    EXPECT_NEAR(area(Disk{m, false, 2, 3, 2, 180}) / (2.5 * pi_d * s * s), 1, 1e-9);
  }
  // Spheroids with half-axes 1, 1, c.
  double e = std::sqrt(0.75);
  EXPECT_NEAR(area(Sphere{scale(1, 1, 2), false, 1, -1, 1, 360}) / (2 * pi_d * (1 + 2 / e * std::asin(e))), 1, 1e-6);
  EXPECT_NEAR(area(Sphere{scale(1, 1, 0.5), false, 1, -1, 1, 360}) / (2 * pi_d * (1 + 0.25 / e * std::atanh(e))), 1,
              1e-6);
  // The circumference of an ellipse with half-axes 3 and 1 is 12 E(k), k^2 = 8/9.
  EXPECT_NEAR(area(Cylinder{scale(3, 1, 1), false, 1, 0, 1, 360}) / (12 * std::comp_ellint_2(std::sqrt(8.0 / 9))), 1,
              1e-9);
  EXPECT_NEAR(area(BilinearPatch{{Vec3f{0, 0, 0}, Vec3f{2, 0, 0}, Vec3f{0, 3, 4}, Vec3f{2, 3, 4}}}), 10, 1e-9);
  // z = x y over the unit square: the integral of sqrt(1 + x^2 + y^2) is 1.28078...
  BilinearPatch saddle{{Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{1, 1, 1}}};
  double truth = std::sqrt(3.0) / 3 + 2.0 / 3 * std::log((1 + std::sqrt(3.0)) / std::sqrt(2.0)) * 2 - pi_d / 18;
  EXPECT_NEAR(area(saddle), truth, 1e-7);
}

}  // namespace
}  // namespace montelux
