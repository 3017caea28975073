// Cameras seen from the scene: connections are the rays that the camera generates, and their densities integrate to one
// over each pixel.
#include <gtest/gtest.h>

#include <cmath>

#include "camera/camera.h"
#include "mc/hemisphere.h"
#include "mc/moments.h"
#include "statistics.h"

namespace montelux::test {
namespace {

using P = NativeFloats;
constexpr int width = 12, height = 8;

struct Case {
  std::string name;
  Camera camera;
  bool directions = true;  // sees_directions()
};

Camera camera(const CameraDesc& stated, const Transform& world_to_camera) {
  Diagnostics diagnostics;
  Camera built = build_camera(stated, world_to_camera, width, height, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  return built;
}

std::vector<Case> cases() {
  const Transform placed = rotate(30, 1, 2, 0.5) * translate(-1, 0.5, 2), skew = scale(1, 1.4, 0.8) * placed;
  std::vector<Case> all{
      {"pinhole", camera(CameraDesc{.fov = 70}, placed)},
      {"pinhole, skew", camera(CameraDesc{.fov = 50}, skew)},
      {"thin lens", camera(CameraDesc{.fov = 60, .lens_radius = 0.3f, .focal_distance = 3}, placed)},
      {"thin lens of six blades",
       camera(
           CameraDesc{
               .fov = 60, .lens_radius = 0.3f, .focal_distance = 3, .aperture_blades = 6, .aperture_rotation = 20},
           skew)},
      {"orthographic", camera(CameraDesc{.kind = CameraKind::orthographic}, placed), false},
      {"orthographic thin lens",
       camera(CameraDesc{.kind = CameraKind::orthographic, .lens_radius = 0.3f, .focal_distance = 3}, skew), false},
      {"equal-area sphere", camera(CameraDesc{.kind = CameraKind::spherical}, placed)},
      {"equirectangular sphere",
       camera(CameraDesc{.kind = CameraKind::spherical, .mapping = SpherePicture::equirectangular}, skew)}};
  const Motion motion(Transform{}, translate(0.5, 0, 0.2) * rotate(25, 0, 1, 0) * scale(1.3, 0.8, 1.1));
  all.push_back({"moving pinhole", camera(CameraDesc{.fov = 70}, placed).moved(motion)});
  all.push_back(
      {"moving orthographic", camera(CameraDesc{.kind = CameraKind::orthographic}, placed).moved(motion), false});
  return all;
}

// The point at that way along the ray, and where the rays of neighbouring places meet the plane across it there.
struct Neighbours {
  Vec3f p, along_x, along_y;
};
Neighbours neighbours(const Camera& c, Vec2f raster, Vec2f u, float time, float way, float step) {
  const Ray<float> middle = c.generate(raster, u, time).ray;
  const Vec3f p = middle.o + middle.d * way;
  const auto meet = [&](Vec2f at) {
    const Ray<float> r = c.generate(at, u, time).ray;
    return r.o + r.d * (dot(middle.d, p - r.o) / dot(middle.d, r.d));
  };
  return {p, (meet({raster.x + step, raster.y}) - meet({raster.x - step, raster.y})) * (0.5f / step),
          (meet({raster.x, raster.y + step}) - meet({raster.x, raster.y - step})) * (0.5f / step)};
}

TEST(LensConnection, is_the_ray_that_the_camera_generates_and_a_planted_fault_is_found) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    RandomStream<float> r(1, 2);
    int off = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec2f raster{0.5f + (width - 1.0f) * r.next(), 0.5f + (height - 1.0f) * r.next()}, u = r.next2();
      const float time = r.next(), way = 0.5f + 5 * r.next();
      const Neighbours near = neighbours(c.camera, raster, u, time, way, 0.02f);
      const Ray<float> ray = c.camera.generate(raster, u, time).ray;
      const LensConnection<float> found = c.camera.toward(near.p, u, time);
      ASSERT_TRUE(found.seen);
      EXPECT_NEAR(found.distance, way, 1e-4f * way);
      EXPECT_LT(length(found.p - ray.o), 1e-4f);
      EXPECT_LT(length(found.d - ray.d), 1e-4f);
      EXPECT_NEAR(found.raster.x, raster.x, 2e-3f);
      EXPECT_NEAR(found.raster.y, raster.y, 2e-3f);
      const double area = double(length(cross(near.along_x, near.along_y)));
      off += std::abs(double(found.across.value) * area - 1) > 4e-3;
      EXPECT_GT(std::abs(1.01 * double(found.across.value) * area - 1), 4e-3);
      // Behind the camera, save for one that looks everywhere.
      const bool everywhere = std::holds_alternative<SphericalCamera>(c.camera.variant());
      EXPECT_EQ(c.camera.toward(ray.o - ray.d * way, u, time).seen, everywhere);
    }
    // The equal-area map has creases, which finite differences may reach across.
    EXPECT_LE(off, c.name == "equal-area sphere" ? 15 : 0);
  }
}

TEST(LensConnection, states_the_density_over_the_lens) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const LensConnection<float> found = c.camera.toward(
        c.camera.generate(Vec2f{5, 5}, {0.5f, 0.5f}).ray.o + c.camera.generate(Vec2f{5, 5}, {0.5f, 0.5f}).ray.d,
        Vec2f{0.5f, 0.5f});
    const bool open = c.name.find("thin lens") != std::string::npos;
    EXPECT_EQ(found.delta_lens, !open);
    if (!open) {
      EXPECT_EQ(found.lens.value, 1.0f);
      continue;
    }
    // The area inside the rim, as the places of a fine ring.
    double area = 0;
    const auto rim = [&](int k) {
      const Vec2f u{1, float(k % 2000) / 2000};
      // The last ring of the square in order around it.
      const float t = 4 * u.y, f = t - std::floor(t);
      const Vec2f at = t < 1 ? Vec2f{1, f} : t < 2 ? Vec2f{1 - f, 1} : t < 3 ? Vec2f{0, 1 - f} : Vec2f{f, 0};
      return c.camera.generate(Vec2f{5, 5}, at).ray.o;
    };
    const Vec3f centre = c.camera.generate(Vec2f{5, 5}, {0.5f, 0.5f}).ray.o;
    for (int k = 0; k < 2000; ++k) area += 0.5 * double(length(cross(rim(k) - centre, rim(k + 1) - centre)));
    EXPECT_NEAR(double(found.lens.value) * area, 1, 2e-3);
  }
}

// The share of a cone of directions, weighted by pixels per steradian, that falls into one pixel.
Moments pixels_of_directions(const Camera& c, int x, int y, double fault) {
  RandomStream<float> r(3, 4);
  Moments m;
  const Vec2f u{0.3f, 0.8f};
  const Ray<float> middle = c.generate(Vec2f{float(x) + 0.5f, float(y) + 0.5f}, u).ray;
  float one_minus_cos = 0;
  for (const Vec2f corner : {Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{0, 1}, Vec2f{1, 1}, Vec2f{0.5f, 0}, Vec2f{0.5f, 1}}) {
    const Vec3f d = c.generate(Vec2f{float(x) + corner.x, float(y) + corner.y}, u).ray.d;
    one_minus_cos = max(one_minus_cos, 1.2f * (1 - dot(d, middle.d)));
  }
  const LocalFrame<float> frame = LocalFrame<float>::from_normal(middle.d);
  for (int i = 0; i < 1500000; ++i) {
    const Vec3f w = frame.to_world(sample_cone(one_minus_cos, r.next2()));
    const LensDirection<float> seen = c.toward_direction(w, u);
    const bool inside = seen.seen && int(std::floor(seen.raster.x)) == x && int(std::floor(seen.raster.y)) == y;
    m.add(inside ? fault * double(seen.density.value / cone_density(one_minus_cos).value) : 0.0);
  }
  return m;
}

TEST(LensDirection, has_densities_of_one_over_each_pixel_and_one_percent_more_is_found) {
  const std::pair<int, int> pixels[] = {{1, 2}, {5, 3}, {11, 5}};
  const double level = sidak_level(family_level, double(cases().size() * std::size(pixels)));
  for (const Case& c : cases()) {
    EXPECT_EQ(c.camera.sees_directions(), c.directions);
    if (!c.directions) {
      EXPECT_FALSE(c.camera.toward_direction(Vec3f{0, 0, 1}, {0.5f, 0.5f}).seen);
      continue;
    }
    for (const auto& pixel : pixels) {
      const int x = pixel.first, y = pixel.second;
      SCOPED_TRACE(c.name + ", " + std::to_string(x) + ", " + std::to_string(y));
      const auto p_value = [&](double fault) {
        const Moments m = pixels_of_directions(c.camera, x, y, fault);
        return z_test(m.mean, std::sqrt(m.variance() / double(m.count)), 1).p_value;
      };
      EXPECT_GT(p_value(1), level);
      EXPECT_LT(p_value(1.01), level);
    }
  }
}

// What a camera of all directions shows beyond the edge of its picture stands within it, too.
TEST(SphericalPlaces, outside_the_picture_show_the_same_as_inside) {
  for (const Case& c : cases()) {
    if (!std::holds_alternative<SphericalCamera>(c.camera.variant())) continue;
    SCOPED_TRACE(c.name);
    RandomStream<float> r(5, 6);
    int outside = 0;
    for (int i = 0; i < 500; ++i) {
      // A place near the edge, outside or inside, and where its direction stands.
      const Vec2f at{-1.4f + (width + 2.8f) * r.next(), -1.4f + (height + 2.8f) * r.next()};
      const Vec3f d = c.camera.generate(at, {0.5f, 0.5f}).ray.d;
      const Vec2f inside = c.camera.toward_direction(d, Vec2f{0.5f, 0.5f}).raster;
      int found = 0;
      c.camera.for_each_place(inside, [&](Vec2f place) {
        found += std::hypot(place.x - at.x, place.y - at.y) < 0.02f;
        if (place.x < -1.5f || place.x > width + 1.5f || place.y < -1.5f || place.y > height + 1.5f) return;
        outside += place.x < 0 || place.x > width || place.y < 0 || place.y > height;
        EXPECT_LT(length(c.camera.generate(place, {0.5f, 0.5f}).ray.d - d), 2e-3f);
      });
      EXPECT_EQ(found, 1) << at.x << ", " << at.y;
    }
    EXPECT_GT(outside, 100);
  }
}

TEST(LensConnection, is_the_same_in_lanes) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    RandomStream<float> r(7, 8);
    Vec3<P> p;
    Vec2<P> u;
    P time;
    for (int k = 0; k < native_lanes; ++k)
      set_lane(p, k, {4 * r.next(), 4 * r.next(), 4 * r.next()}), set_lane(u, k, r.next2()),
          set_lane(time, k, r.next());
    const LensConnection<P> many = c.camera.toward(p, u, time);
    const LensDirection<P> directions = c.camera.toward_direction(normalize(p), u, time);
    for (int k = 0; k < native_lanes; ++k) {
      const LensConnection<float> one = c.camera.toward(lane(p, k), lane(u, k), lane(time, k));
      EXPECT_EQ(lane(many.seen, k), one.seen);
      EXPECT_EQ(lane(many.raster, k).x, one.raster.x);
      EXPECT_EQ(lane(many.across.value, k), one.across.value);
      const auto way = c.camera.toward_direction(normalize(lane(p, k)), lane(u, k), lane(time, k));
      EXPECT_EQ(lane(directions.seen, k), way.seen);
      if (way.seen) {
        EXPECT_EQ(lane(directions.density.value, k), way.density.value);
      }
    }
  }
}

}  // namespace
}  // namespace montelux::test
