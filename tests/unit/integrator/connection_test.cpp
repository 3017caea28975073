// Which points of lamps a surface point may be joined to: those in its own plane are not, those close to it are.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "integrator/restir/vertex.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

// A lamp at y = 1 that shines down, a band below it that is wider than it is far from the lamp, and a board in the
// lamp's own plane, turned by a corner about the view.
TestScene scene_turned_by(double degrees) {
  return TestScene(fmt::format(R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt 0 0.9 2  0 0.9 0  0 1 0
Camera "orthographic"
WorldBegin
Rotate {} 0 0 1
AttributeBegin
AreaLightSource "diffuse"
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point3 P" [ -1 1 -1  1 1 -1  1 1 1  -1 1 1 ]
AttributeEnd
Material "diffuse"
Shape "curve" "point3 P" [ -1 0.85 0  -0.3 0.85 0  0.3 0.85 0  1 0.85 0 ] "float width" [ 0.2 ]
Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point3 P" [ 2 1 -1  3 1 -1  2 1 1 ]
)",
                               degrees));
}

// The largest target of a few points of the lamp, at the surface that a ray meets.
float largest_target_along(const TestScene& scene, Vec3f o, Vec3f d) {
  const Ray<float> ray{o, d, ray_infinity};
  const auto [found, hit] = scene.accel().trace<float>(ray, true);
  EXPECT_TRUE(found);
  const RandomStream<float> random(1, 2);
  const Vertex<float> v(scene.scene(), {ray, hit, no_media<float>()}, {true, true}, {TransportMode::radiance, random});
  const ReuseVertex<float> vertex = vertex_behind(ReuseVertex<float>{}, v);
  const LightSet& lights = scene.scene().lights;
  float largest = 0;
  for (std::uint32_t light = 0; light < lights.count(); ++light)
    for (float u : {0.1f, 0.4f, 0.7f, 0.95f}) {
      const LightPointDraw<float> draw =
          lights.draw_light_point<float>(light, v.x.point.p, {0, 0, 0}, {u, 1 - u}, true);
      largest = std::max(largest, connect<float>(scene.scene().media, lights, vertex, draw.point, true).target);
    }
  return largest;
}

TEST(Connection, reaches_lamps_closer_than_a_band_is_wide) {
  for (const double degrees : {0.0, 30.0, 45.0}) {
    const TestScene scene = scene_turned_by(degrees);
    const Transform turn = rotate(degrees, 0, 0, 1);
    // The band reaches from 0.75 to 0.95.
    for (float y : {0.76f, 0.81f, 0.9f, 0.94f})
      EXPECT_GT(largest_target_along(scene, turn.point(Vec3f{0.1f, y, 2}), {0, 0, -1}), 1e-3f) << degrees << " " << y;
  }
}

TEST(Connection, is_none_within_the_plane_of_the_lamp) {
  for (const double degrees : {0.0, 30.0, 45.0}) {
    const TestScene scene = scene_turned_by(degrees);
    const Transform turn = rotate(degrees, 0, 0, 1);
    for (float x : {2.1f, 2.3f})
      EXPECT_EQ(largest_target_along(scene, turn.point(Vec3f{x, 0, 0}), turn.direction(Vec3f{0, 1, 0})), 0) << degrees;
  }
}

}  // namespace
}  // namespace montelux::test
