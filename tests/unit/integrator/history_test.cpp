// Where surface points were in the picture before, against rays that look there; what is won by knowing it; and which
// surfaces are taken for the same.
#include "integrator/restir/history.h"

#include <gtest/gtest.h>

#include <numbers>

#include "reuse_scenes.h"

namespace montelux::test {
namespace {

constexpr int size = 64;

// Boards and balls before a wall, all static except one mesh and one ball; the camera pans and rolls a little.
std::string panning_scene() {
  std::string text =
      moving_camera_head(size, "-0.5 1 -6  -0.5 0.8 0  0 1 0", "0.5 1.1 -5.5  1.2 0.8 0  0.1 1 0", 40) + R"(WorldBegin
LightSource "infinite"
Shape "bilinearmesh" "point3 P" [ -9 -5 3  9 -5 3  -9 6 3  9 6 3 ]
AttributeBegin
ActiveTransform EndTime
Translate 0.6 0.3 -0.2
Rotate 40 0 1 0
ActiveTransform All
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point3 P" [ -1 1 -1  -0.2 1 -1.2  -0.2 1.8 -1  -1 1.8 -0.8 ]
AttributeEnd
AttributeBegin
ActiveTransform EndTime
Translate -0.4 0 0.3
ActiveTransform All
Translate 0.8 -0.6 -1
Shape "sphere" "float radius" [ 0.4 ]
AttributeEnd
)";
  for (int i = 0; i < 24; ++i) {
    const double x = -4 + 0.36 * i, z = 0.3 * (i * 5 % 7), y = 0.4 * (i * 3 % 5) - 0.6;
    text += fmt::format("Shape \"bilinearmesh\" \"point3 P\" [ {} {} {}  {} {} {}  {} {} {}  {} {} {} ]\n", x, y, z,
                        x + 0.3, y, z, x, y + 0.5, z, x + 0.3, y + 0.5, z);
  }
  return text;
}

const TestScene& panning() {
  static const TestScene s{panning_scene()};
  return s;
}

struct Seen {
  bool found = false;
  VertexOrigin<float> origin{};
  SurfaceHit<float> surface{};
};
Seen look(Vec2f raster, float time) {
  const Scene& scene = panning().scene();
  Seen seen;
  seen.origin.ray = scene.camera.generate(raster, Vec2f{0.5f, 0.5f}, time).ray;
  const auto [found, hit] = panning().accel().trace<float>(seen.origin.ray, true);
  seen.found = found, seen.origin.hit = hit, seen.origin.straight = true;
  if (found) seen.surface = surface<float>(scene.geometry, seen.origin.ray, hit, true);
  return seen;
}

constexpr float then = 0.3f, now = 0.5f;

TEST(Motion, leads_to_where_the_same_point_was_seen_before) {
  int same = 0, hidden = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const Seen here = look({float(x) + 0.5f, float(y) + 0.5f}, now);
      ASSERT_TRUE(here.found);
      const EarlierPlace<float> earlier = earlier_place<float>(panning().scene(), here.origin, then, true);
      ASSERT_TRUE(earlier.place.seen);
      const Vec2f r = earlier.place.raster;
      if (r.x < 0 || r.y < 0 || r.x >= size || r.y >= size) continue;
      const Seen there = look(r, then);
      ASSERT_TRUE(there.found);
      // What stood in front then was nearer; else it is the same point of the same surface.
      if (there.origin.hit.t < earlier.place.distance * (1 - 1e-3f)) {
        ++hidden;
        continue;
      }
      ++same;
      // Some roundings of a distance below ten, and of a unit vector.
      EXPECT_NEAR(there.origin.hit.t, earlier.place.distance, 1e-5f) << x << " " << y;
      EXPECT_EQ(there.surface.object, here.surface.object) << x << " " << y;
      EXPECT_NEAR(dot(there.surface.point.ng, earlier.ng), 1, 1e-6f) << x << " " << y;
    }
  EXPECT_GT(same, 3000);
  EXPECT_GT(hidden, 50);
}

// A picture as series remember it.
ReuseMemory remembered(float time) {
  ReuseMemory memory;
  memory.bounds = {0, 0, size, size};
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const Seen seen = look({float(x) + 0.5f, float(y) + 0.5f}, time);
      ReuseVertex<float> v{};
      v.exists = seen.found, v.object = seen.surface.object, v.depth = seen.origin.hit.t;
      v.p = seen.surface.point.p, v.ng = seen.surface.point.ng;
      memory.vertices.push_back(v);
    }
  return memory;
}

TEST(Motion, finds_the_history_of_most_pixels_of_a_panning_camera) {
  const ReuseMemory before = remembered(then);
  int by_motion = 0, by_place = 0, there_by_place = 0, wrong = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const Seen here = look({float(x) + 0.5f, float(y) + 0.5f}, now);
      const EarlierPlace<float> earlier = earlier_place<float>(panning().scene(), here.origin, then, true);
      const SoughtSurface sought{here.surface.object, earlier.ng, earlier.place.distance};
      const Vec3f was =
          surface_at<float>(panning().scene().geometry, here.origin.ray, here.origin.hit, then, true).point.p;
      // Within two pixels, of which one is 0.136 wide where the wall is.
      const auto is_near = [&](const ReuseVertex<float>& v) { return length(v.p - was) < 0.3f; };
      if (const auto pixel = earlier_pixel(before, earlier.place.raster, sought)) {
        ++by_motion;
        wrong += !is_near(before.vertices[*pixel]);
      }
      const ReuseVertex<float>& same = before.vertices[std::size_t(y * size + x)];
      by_place += same.object == here.surface.object;
      there_by_place += same.object == here.surface.object && is_near(same);
    }
  printf("history of the right object: %d of %d pixels by motion, %d by place (of the same spot: %d)\n", by_motion,
         size * size, by_place, there_by_place);
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(by_motion, 3750);  // of 4096; all but what came into view and thin edges
  EXPECT_GT(by_motion, 1.2 * by_place);
  EXPECT_GT(by_motion, 4 * there_by_place);
}

// What a pixel shows whose normal is turned by so many degrees.
ReuseVertex<float> shown(double degrees, float depth, std::uint32_t object = 3) {
  const double angle = degrees * std::numbers::pi / 180;
  ReuseVertex<float> v{};
  v.exists = 1, v.object = object, v.depth = depth;
  v.ng = {float(std::sin(angle)), 0, float(std::cos(angle))};
  return v;
}
constexpr SoughtSurface sought{3, {0, 0, 1}, 10};

TEST(History, is_taken_within_25_degrees_and_a_tenth_of_the_distance) {
  for (double degrees : {0.0, 24.9, 180 - 24.9, 180.0})
    for (float depth : {9.01f, 10.0f, 10.99f})
      EXPECT_TRUE(sought.is_like(shown(degrees, depth))) << degrees << " " << depth;
  for (double degrees : {25.1, 90.0, 180 - 25.1}) EXPECT_FALSE(sought.is_like(shown(degrees, 10))) << degrees;
  for (float depth : {0.0f, 8.99f, 11.01f}) EXPECT_FALSE(sought.is_like(shown(0, depth))) << depth;
  EXPECT_FALSE(sought.is_like(shown(0, 10, 4)));
  ReuseVertex<float> none = shown(0, 10);
  none.exists = 0;
  EXPECT_FALSE(sought.is_like(none));
}

TEST(History, is_of_the_nearest_of_four_pixels_that_shows_the_surface) {
  ReuseMemory memory;
  memory.bounds = {7, 9, 11, 13};
  memory.vertices.assign(16, shown(0, 10));
  const auto at = [](std::size_t x, std::size_t y) { return (y - 9) * 4 + (x - 7); };
  // Nearer to the right edge of its pixel than to the upper one.
  const Vec2f place{9.9f, 10.3f};
  for (const std::size_t pixel : {at(9, 10), at(10, 10), at(9, 9), at(10, 9)}) {
    EXPECT_EQ(earlier_pixel(memory, place, sought), pixel);
    memory.vertices[pixel] = shown(25.1, 10);
  }
  EXPECT_EQ(earlier_pixel(memory, place, sought), std::nullopt);
}

TEST(History, is_nowhere_outside_of_a_crop) {
  ReuseMemory memory;
  memory.bounds = {7, 9, 31, 26};
  EXPECT_EQ(memory.pixel_at(7.0f, 9.0f), std::size_t{0});
  EXPECT_EQ(memory.pixel_at(8.9f, 11.2f), std::size_t{2 * 24 + 1});
  EXPECT_EQ(memory.pixel_at(30.9f, 25.9f), std::size_t{24 * 17 - 1});
  for (const Vec2f& out : {Vec2f{6.9f, 20}, {31, 20}, {20, 8.9f}, {20, 26}, {0, 0}, {NAN, 20}})
    EXPECT_EQ(memory.pixel_at(out.x, out.y), std::nullopt) << out.x << " " << out.y;
}

// The camera slides to the right before a wall with a mirror in front of it, which shows the wall behind the camera.
std::string mirror_scene() {
  return moving_camera_head(size, "0 1 -6  0 1 0  0 1 0", "1 1 -6  1 1 0  0 1 0", 40) + R"(WorldBegin
LightSource "infinite"
Shape "bilinearmesh" "point3 P" [ -12 -12 3  12 -12 3  -12 12 3  12 12 3 ]
Shape "bilinearmesh" "point3 P" [ -12 -12 -12  12 -12 -12  -12 12 -12  12 12 -12 ]
Material "conductor" "float roughness" [ 0 ]
Shape "bilinearmesh" "point3 P" [ -0.8 0.2 0  1.2 0.2 0  -0.8 1.8 0  1.2 1.8 0 ]
)";
}

// Every pixel of the picture before has a confidence of its own, by which it is known in the next one.
TEST(History, behind_a_mirror_is_that_of_the_pixel_itself) {
  const TestScene scene(mirror_scene());
  const ChosenIntegrator chosen = scene.integrator("restir-di:neighbours=0,m-cap=100000");
  RenderSettings s = scene.settings(PointSetKind::blue_noise, {1, 1}, 1, 2);
  SeriesMemories memories;
  s.sequence.memories = &memories, s.image.shutter = Shutter{0, 0};
  RenderObserver silent;
  render(chosen.any(), s, silent);
  const auto before = std::make_shared<ReuseMemory>(dynamic_cast<const ReuseMemory&>(*memories.at(0)));
  for (std::size_t i = 0; i < before->lights.size(); ++i) before->lights[i].confidence = float(i + 1);
  memories[0] = before;
  s.image.shutter = Shutter{0.5f, 0.5f}, s.image.seed = 2;
  render(chosen.any(), s, silent);
  const auto& after = dynamic_cast<const ReuseMemory&>(*memories.at(0));
  int own = 0, moved = 0;
  for (std::size_t i = 0; i < after.vertices.size(); ++i) {
    const ReuseVertex<float>& v = after.vertices[i];
    ASSERT_EQ(v.exists, 1u);
    // The pixel's own confidence is 1.
    const auto number = std::size_t(after.lights[i].confidence);
    const auto found = number > 1 ? std::optional(number - 2) : std::nullopt;
    if (v.events > 0) {
      const Vec2f middle{float(i % size) + 0.5f, float(i / size) + 0.5f};
      EXPECT_EQ(found, earlier_pixel(*before, middle, {v.object, v.ng, v.depth})) << i;
      own += found == i;
    } else if (found) {
      // Two pixels are 0.2 of the wall, and the camera went by 0.5.
      EXPECT_LT(length(before->vertices[*found].p - v.p), 0.3f) << i;
      ++moved;
    }
  }
  EXPECT_GT(own, 450);     // of 680 that show the mirror, 505 of which showed it before
  EXPECT_GT(moved, 2900);  // of 3410; the others were hidden or out of the picture
}

TEST(Motion, of_a_shutter_goes_to_the_same_share_of_the_exposure) {
  const Shutter before{0.2f, 0.4f}, after{0.6f, 0.7f};
  EXPECT_NEAR(earlier_time(0.6f, after, before), 0.2f, 1e-6f);
  EXPECT_NEAR(earlier_time(0.675f, after, before), 0.35f, 1e-6f);
  EXPECT_NEAR(earlier_time(0.7f, after, {0.5f, 0.5f}), 0.5f, 1e-6f);
  EXPECT_NEAR(earlier_time(0.6f, {0.6f, 0.6f}, before), 0.2f, 1e-6f);
}

}  // namespace
}  // namespace montelux::test
