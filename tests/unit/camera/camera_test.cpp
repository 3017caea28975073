#include "camera/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mc/random.h"

namespace montelux {
namespace {

Camera built(const CameraDesc& e, const Transform& world_to_camera, int width, int height) {
  Diagnostics diagnostics;
  Camera camera = build_camera(e, world_to_camera, width, height, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  return camera;
}
void expect_near(Vec3f a, Vec3f b, float tolerance = 1e-5f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}
Ray<float> ray(const Camera& camera, float x, float y, Vec2f lens = {0.5f, 0.5f}) {
  return camera.generate(Vec2f{x, y}, lens).ray;
}

TEST(PerspectiveCamera, edge_rays_enclose_the_field_of_view_of_the_shorter_axis) {
  Camera wide = built(CameraDesc{.fov = 40}, {}, 640, 480);
  float t = std::tan(20 * pi / 180);
  expect_near(ray(wide, 320, 240).d, {0, 0, 1});
  expect_near(ray(wide, 320, 0).d, normalize(Vec3f{0, t, 1}));
  expect_near(ray(wide, 320, 480).d, normalize(Vec3f{0, -t, 1}));
  expect_near(ray(wide, 640, 240).d, normalize(Vec3f{t * 4 / 3, 0, 1}));
  Camera tall = built(CameraDesc{.fov = 40}, {}, 480, 640);
  expect_near(ray(tall, 0, 320).d, normalize(Vec3f{-t, 0, 1}));
  expect_near(ray(tall, 240, 0).d, normalize(Vec3f{0, t * 4 / 3, 1}));
}

TEST(PerspectiveCamera, screen_window_replaces_the_aspect_of_the_picture) {
  CameraDesc e = CameraDesc{.fov = 90};
  e.screen_window = {-0.5f, 1.0f, -0.25f, 2.0f};
  Camera camera = built(e, {}, 100, 100);
  expect_near(ray(camera, 0, 0).d, normalize(Vec3f{-0.5f, 2, 1}));
  expect_near(ray(camera, 100, 100).d, normalize(Vec3f{1, -0.25f, 1}));
}

TEST(PerspectiveCamera, frame_aspect_ratio_replaces_that_of_the_resolution) {
  Camera camera = built(CameraDesc{.fov = 90, .aspect = 2}, {}, 100, 100);
  expect_near(ray(camera, 0, 50).d, normalize(Vec3f{-2, 0, 1}));
  expect_near(ray(camera, 50, 0).d, normalize(Vec3f{0, 1, 1}));
}

TEST(PerspectiveCamera, looks_from_the_eye_at_the_target_with_right_and_up_on_the_picture) {
  auto view = look_at({1, 2, 3}, {1, 2, 13}, {0, 1, 0});
  ASSERT_TRUE(view);
  Camera camera = built(CameraDesc{}, *view, 200, 200);
  expect_near(ray(camera, 100, 100).o, {1, 2, 3});
  expect_near(ray(camera, 100, 100).d, {0, 0, 1});
  // Left-handed: looking along +z with y up, +x is to the right.
  EXPECT_GT(ray(camera, 199, 100).d.x, 0.5f);
  EXPECT_GT(ray(camera, 100, 1).d.y, 0.5f);
}

TEST(PerspectiveCamera, mirroring_the_camera_space_mirrors_the_picture_and_scaling_it_changes_nothing) {
  auto view = look_at({3, 1, -2}, {0, 0.5, 0}, {0, 1, 0});
  ASSERT_TRUE(view);
  Camera plain = built(CameraDesc{}, *view, 300, 200);
  Camera mirrored = built(CameraDesc{}, scale(-1, 1, 1) * *view, 300, 200);
  Camera scaled = built(CameraDesc{}, scale(7, 7, 7) * *view, 300, 200);
  for (Vec2f p : {Vec2f{12, 30}, Vec2f{150, 100}, Vec2f{250.5f, 199}}) {
    expect_near(ray(mirrored, p.x, p.y).d, ray(plain, 300 - p.x, p.y).d);
    expect_near(ray(mirrored, p.x, p.y).o, {3, 1, -2});
    expect_near(ray(scaled, p.x, p.y).d, ray(plain, p.x, p.y).d);
    EXPECT_NEAR(length(ray(mirrored, p.x, p.y).d), 1, 1e-6f);
  }
}

// Where a ray crosses the plane z = depth of camera space.
Vec3f at_depth(const Ray<float>& r, const Transform& to_camera, float depth) {
  Vec3f o = to_camera.point(r.o), d = to_camera.direction(r.d);
  return o + d * ((depth - o.z) / d.z);
}

TEST(ThinLens, all_rays_of_a_pixel_meet_in_the_plane_in_focus_and_start_on_the_lens) {
  auto view = look_at({3, 1, -2}, {0, 0.5, 0}, {0, 1, 0});
  ASSERT_TRUE(view);
  for (CameraKind kind : {CameraKind::perspective, CameraKind::orthographic}) {
    Camera camera = built({.kind = kind, .lens_radius = 0.25f, .focal_distance = 4}, *view, 300, 200);
    Camera pinhole = built({.kind = kind}, *view, 300, 200);
    RandomStream<float> random(3u, 4u);
    for (int k = 0; k < 100; ++k) {
      Vec2f raster{random.next() * 300, random.next() * 200}, u = random.next2();
      Ray<float> r = ray(camera, raster.x, raster.y, u), centre = ray(pinhole, raster.x, raster.y);
      expect_near(at_depth(r, *view, 4), at_depth(centre, *view, 4), 2e-5f);
      EXPECT_LE(length(r.o - centre.o), 0.25f * 1.00001f);
      EXPECT_NEAR(view->point(r.o).z, 0, 1e-5f);
      EXPECT_NEAR(length(r.d), 1, 1e-6f);
    }
    EXPECT_NEAR(length(ray(camera, 10, 10, {0, 0}).o - ray(camera, 10, 10, {1, 1}).o), 0.5f, 1e-5f);
  }
}

TEST(OrthographicCamera, rays_are_parallel_and_start_on_the_screen_window) {
  Camera camera = built(CameraDesc{.kind = CameraKind::orthographic}, translate(0, 0, 5), 400, 200);
  expect_near(ray(camera, 0, 0).o, {-2, 1, -5});
  expect_near(ray(camera, 400, 200).o, {2, -1, -5});
  expect_near(ray(camera, 17, 120).d, {0, 0, 1});
}

TEST(SphericalCamera, equirectangular_rows_are_polar_angles_about_y) {
  CameraDesc e = CameraDesc{.kind = CameraKind::spherical};
  e.mapping = SpherePicture::equirectangular;
  Camera camera = built(e, {}, 400, 200);
  expect_near(ray(camera, 0, 0).d, {0, 1, 0});
  expect_near(ray(camera, 123, 200).d, {0, -1, 0});
  expect_near(ray(camera, 0, 100).d, {1, 0, 0});
  expect_near(ray(camera, 100, 100).d, {0, 0, 1});
  expect_near(ray(camera, 200, 100).d, {-1, 0, 0});
  expect_near(ray(camera, 300, 100).d, {0, 0, -1});
}

TEST(SphericalCamera, equal_area_centre_is_up_and_corners_are_down) {
  Camera camera = built(CameraDesc{.kind = CameraKind::spherical}, {}, 200, 200);
  expect_near(ray(camera, 100, 100).d, {0, 1, 0});
  expect_near(ray(camera, 0, 0).d, {0, -1, 0});
  expect_near(ray(camera, 200, 100).d, {1, 0, 0});
  expect_near(ray(camera, 100, 200).d, {0, 0, 1});
}

TEST(SphereSquare, the_sphere_map_keeps_areas_and_inverts) {
  // The mean of z^2 and of x^2 y^2 over the sphere are 1/3 and 1/15.
  double zz = 0, xxyy = 0;
  const int n = 600;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      Vec2f uv{(float(i) + 0.5f) / n, (float(j) + 0.5f) / n};
      Vec3f w = sphere_from_square(uv);
      zz += double(w.z) * w.z, xxyy += double(w.x) * w.x * w.y * w.y;
      ASSERT_NEAR(length(w), 1, 1e-6f);
      Vec2f back = square_from_sphere(w);
      ASSERT_NEAR(back.x, uv.x, 2e-5f) << uv.x << " " << uv.y;
      ASSERT_NEAR(back.y, uv.y, 2e-5f) << uv.x << " " << uv.y;
    }
  EXPECT_NEAR(zz / (n * n), 1.0 / 3, 1e-5);
  EXPECT_NEAR(xxyy / (n * n), 1.0 / 15, 1e-5);
}

TEST(SphereSquare, the_sphere_map_continues_across_its_edges) {
  const float e = 1e-4f;
  for (float t : {0.1f, 0.37f, 0.5f, 0.8f}) {
    for (Vec2f out : {Vec2f{-e, t}, Vec2f{1 + e, t}, Vec2f{t, -e}, Vec2f{t, 1 + e}}) {
      Vec2f edge{std::clamp(out.x, 0.0f, 1.0f), std::clamp(out.y, 0.0f, 1.0f)};
      EXPECT_GT(dot(sphere_from_square(wrap_sphere_square(out)), sphere_from_square(edge)), 1 - 1e-5f);
    }
  }
}

TEST(Camera, a_lane_gives_the_bits_of_a_float) {
  using F = NativeFloats;
  auto view = look_at({3, 1, -2}, {0, 0.5, 0}, {0, 1, 0});
  CameraDesc equirectangular = CameraDesc{.kind = CameraKind::spherical};
  equirectangular.mapping = SpherePicture::equirectangular;
  for (const CameraDesc& e : {CameraDesc{.lens_radius = 0.1f, .focal_distance = 3},
                              CameraDesc{.kind = CameraKind::orthographic, .lens_radius = 0.1f},
                              CameraDesc{.kind = CameraKind::spherical}, equirectangular}) {
    Camera camera = built(e, *view, 64, 48);
    RandomStream<float> random(5u, 6u);
    for (int round = 0; round < 50; ++round) {
      Vec2<F> raster, u;
      for (int k = 0; k < native_lanes; ++k) {
        set_lane(raster, k, Vec2f{random.next() * 64, random.next() * 48});
        set_lane(u, k, random.next2());
      }
      CameraRay<F> pack = camera.generate(raster, u);
      for (int k = 0; k < native_lanes; ++k) {
        Ray<float> one = camera.generate(lane(raster, k), lane(u, k)).ray;
        Vec3f o = lane(pack.ray.o, k), d = lane(pack.ray.d, k);
        ASSERT_TRUE(o.x == one.o.x && o.y == one.o.y && o.z == one.o.z) << name_of(e.kind);
        ASSERT_TRUE(d.x == one.d.x && d.y == one.d.y && d.z == one.d.z) << name_of(e.kind);
      }
    }
  }
}

TEST(Camera, in_motion_is_the_camera_that_stands_there_at_each_end_and_half_way_between) {
  const CameraDesc e = CameraDesc{.fov = 40, .lens_radius = 0.3f, .focal_distance = 4};
  const Transform start = *look_at({1, 2, 3}, {0, 0, 0}, {0, 1, 0});
  const Transform turn = rotate(60, 1, 2, 3), shift = translate(4, 0, 0);
  const Transform end = start * (shift * turn).inverted();
  const Camera moving = built(e, {}, 64, 48).moved({start.inverted(), end.inverted()});
  ASSERT_TRUE(moving.moves());
  const Transform middle = start * rotate(30, 1, 2, 3).inverted();
  for (auto [time, place] : {std::pair{0.0f, start}, {1.0f, end}}) {
    const Ray<float> a = moving.generate(Vec2f{10, 40}, Vec2f{0.2f, 0.9f}, time).ray;
    const Ray<float> b = ray(built(e, place, 64, 48), 10, 40, {0.2f, 0.9f});
    expect_near(a.o, b.o), expect_near(a.d, b.d);
    EXPECT_EQ(a.time, time);
  }
  // The direction turns by the half; the eye goes straight.
  expect_near(moving.generate(Vec2f{32, 24}, Vec2f{0.5f, 0.5f}, 0.5f).ray.d, ray(built(e, middle, 64, 48), 32, 24).d);
  const Vec3f eyes = start.inverted().point(Vec3f{0, 0, 0}) + end.inverted().point(Vec3f{0, 0, 0});
  expect_near(moving.generate(Vec2f{32, 24}, Vec2f{0.5f, 0.5f}, 0.5f).ray.o, eyes * 0.5f);
}

// Every camera at rest and in motion, in skew and mirrored spaces.
std::vector<Camera> all_cameras(int width, int height) {
  CameraDesc equirectangular = CameraDesc{.kind = CameraKind::spherical};
  equirectangular.mapping = SpherePicture::equirectangular;
  const Transform view = scale(-1, 1, 1.5) * *look_at({3, 1, -2}, {0, 0.5, 0}, {0, 1, 0});
  const Transform end = rotate(50, 1, 2, -1) * translate(1, -2, 0.5);
  std::vector<Camera> cameras;
  for (const CameraDesc& e :
       {CameraDesc{.fov = 70}, CameraDesc{.fov = 15}, CameraDesc{.kind = CameraKind::orthographic},
        CameraDesc{.kind = CameraKind::spherical}, equirectangular}) {
    cameras.push_back(built(e, view, width, height));
    cameras.push_back(built(e, {}, width, height).moved({view.inverted(), (end * view).inverted()}));
  }
  return cameras;
}

TEST(Camera, projects_the_points_of_its_rays_to_where_they_come_from) {
  using F = NativeFloats;
  RandomStream<float> random(8u, 1u);
  for (const Camera& camera : all_cameras(64, 48))
    for (int round = 0; round < 200; ++round) {
      const Vec2f raster{2 + random.next() * 60, 2 + random.next() * 44};
      const float time = random.next(), distance = 0.2f + 30 * random.next();
      const Ray<float> r = camera.generate(raster, Vec2f{0.5f, 0.5f}, time).ray;
      const Vec3f p = r.o + r.d * distance;
      const Projection<float> back = camera.project(p, time);
      ASSERT_TRUE(back.seen);
      // Of the point and the camera's place some operations leave 2^-21 of what they are, seen from the distance in a
      // picture of at most 64 pixels in 15 degrees.
      const float rounding = 1e-5f + (length(p) + length(r.o)) / distance * 0x1p-21f * 250;
      ASSERT_NEAR(back.raster.x, raster.x, rounding) << camera.variant().index() << " " << camera.moves();
      ASSERT_NEAR(back.raster.y, raster.y, rounding) << camera.variant().index() << " " << camera.moves();
      ASSERT_NEAR(back.distance, distance, 1e-4f * distance + 1e-4f);
      const Projection<F> pack = camera.project(Vec3<F>{F(p.x), F(p.y), F(p.z)}, F(time));
      ASSERT_EQ(lane(pack.raster.x, 0), back.raster.x);
      ASSERT_TRUE(all(pack.seen));
    }
}

TEST(Camera, does_not_see_points_behind_it) {
  for (const Camera& camera : all_cameras(64, 48)) {
    const Ray<float> r = camera.generate(Vec2f{20, 30}, Vec2f{0.5f, 0.5f}, 0.3f).ray;
    const bool all_around = std::holds_alternative<SphericalCamera>(camera.variant());
    EXPECT_EQ(camera.project(r.o - r.d * 2.0f, 0.3f).seen, all_around);
  }
}

TEST(Camera, projects_through_the_centre_of_its_lens) {
  const CameraDesc e = CameraDesc{.fov = 40, .lens_radius = 0.3f, .focal_distance = 4};
  const Camera camera = built(e, *look_at({1, 2, 3}, {0, 0, 0}, {0, 1, 0}), 64, 48);
  // In the plane in focus all rays of a raster place meet.
  const Ray<float> a = camera.generate(Vec2f{32, 24}, Vec2f{0.1f, 0.9f}).ray;
  const Ray<float> axis = camera.generate(Vec2f{32, 24}, Vec2f{0.5f, 0.5f}).ray;
  const Vec3f p = a.o + a.d * (4 / dot(a.d, axis.d));
  // To some roundings of a raster place.
  EXPECT_NEAR(camera.project(p).raster.x, 32, 2e-5f);
  EXPECT_NEAR(camera.project(p).raster.y, 24, 2e-5f);
}

TEST(Camera, blades_make_a_polygon_of_the_lens_with_its_first_corner_turned) {
  CameraDesc e =
      CameraDesc{.kind = CameraKind::orthographic, .lens_radius = 2, .focal_distance = 5, .aperture_rotation = 30};
  e.aperture_blades = 5;
  const Camera camera = built(e, {}, 10, 10);
  // Places next to the rim of the square go next to that of the polygon, whose corners are at distance 2.
  float farthest = 0, nearest = 9;
  Vec3f corner{0, 0, 0};
  for (int i = 0; i < 4000; ++i) {
    const Vec3f o = ray(camera, 5, 5, {1e-6f, (float(i) + 0.5f) / 4000}).o;
    const float distance = length(o);
    if (distance > farthest) farthest = distance, corner = o;
    nearest = std::min(nearest, distance);
  }
  // Places on the rim are 2.9e-3 apart. A corner is missed by half of that at most, times cos 54 degrees; the middle of
  // a side, where the distance is least, and the angle of a corner by less.
  EXPECT_NEAR(farthest, 2, 1e-3f);
  EXPECT_NEAR(nearest, 2 * std::cos(pi / 5), 1e-5f);
  const float turns = (std::atan2(corner.y, corner.x) * 180 / pi - 30) / 72;
  EXPECT_NEAR(turns, std::round(turns), 1e-3f);
}

TEST(Camera, values_that_make_no_camera_are_reported) {
  for (const CameraDesc& e : {CameraDesc{.fov = 180}, CameraDesc{.aspect = 0},
                              CameraDesc{.kind = CameraKind::orthographic, .lens_radius = 1, .focal_distance = 0},
                              CameraDesc{.screen_window = {{1, 1, 0, 1}}}}) {
    Diagnostics diagnostics;
    build_camera(e, {}, 10, 10, diagnostics);
    EXPECT_TRUE(diagnostics.has_errors()) << name_of(e.kind);
  }
}

}  // namespace
}  // namespace montelux
