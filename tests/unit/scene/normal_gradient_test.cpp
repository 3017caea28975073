// The derivative of the shading normal, against the normals of neighbouring points.
#include "scene/normal_gradient.h"

#include <gtest/gtest.h>

#include "render_scenes.h"

namespace montelux::test {
namespace {

const std::string head =
    "Film \"rgb\" \"integer xresolution\" [ 8 ] \"integer yresolution\" [ 8 ]\nCamera \"orthographic\"\nWorldBegin\n"
    "Material \"conductor\"\n";

struct Met {
  SurfaceHit<float> x;
  Hit<float> hit;
};
Met meet(const TestScene& scene, const Vec3f& o, const Vec3f& d, float time) {
  const Ray<float> ray{o, normalize(d), ray_infinity, time};
  const auto [found, hit] = scene.accel().trace<float>(ray, true);
  EXPECT_TRUE(found);
  return {surface<float>(scene.scene().geometry, {ray.o, ray.d, hit.t, time}, hit, true), hit};
}

// Rays about the z axis from below meet the surface at places whose normals are compared with those next to them.
void expect_derivative(const std::string& shape, float time = 0) {
  SCOPED_TRACE(shape);
  const TestScene scene(head + shape);
  constexpr float step = 4e-3f;
  const Vec3f d{0.05f, -0.03f, 1};
  bool changes = false;
  for (const Vec2f at : {Vec2f{0.31f, 0.13f}, {-0.2f, 0.22f}, {0.11f, -0.34f}}) {
    const auto from = [&](float x, float y) { return meet(scene, {at.x + x, at.y + y, -5}, d, time); };
    const Met here = from(0, 0);
    const NormalGradient gradient =
        normal_gradient(scene.scene().geometry, here.hit, here.x.point.p, here.x.point.ns, time);
    for (const Vec2f way : {Vec2f{1, 0}, {0, 1}}) {
      const Met a = from(-step * way.x, -step * way.y), b = from(step * way.x, step * way.y);
      if (a.hit.primitive != b.hit.primitive) continue;
      const Vec3d dp = to_double(b.x.point.p - a.x.point.p), dn = to_double(b.x.point.ns - a.x.point.ns);
      const double size = std::max(norm(dp), norm(dn));
      EXPECT_LT(norm(gradient.along(dp) - dn), 2e-3 * size) << at.x << " " << at.y;
      changes = changes || norm(dn) > 0.01 * size;
    }
  }
  EXPECT_EQ(changes, shape.find("disk") == std::string::npos);
}

const std::string normals = "\"normal N\" [ -0.3 -0.2 -1  0.6 -0.4 -2  0.1 0.3 -0.7  -0.2 0.4 -1.5 ]\n";
const std::string moving = "ActiveTransform EndTime\nRotate 40 0 0 1\nScale 1.2 1 0.7\nActiveTransform All\n";

TEST(NormalGradient, is_that_of_neighbouring_normals_on_every_shape) {
  const std::string shapes[] = {
      "Shape \"sphere\" \"float radius\" [ 0.8 ]\n",
      "Shape \"disk\" \"float radius\" [ 2 ]\n",
      "Rotate 90 0 1 0\nShape \"cylinder\" \"float radius\" [ 0.9 ] \"float zmin\" [ -2 ] \"float zmax\" [ 2 ]\n",
      "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0  1 -1 0.3  -1 1 0.2  1 1 -0.4 ]\n",
      "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0  1 -1 0.3  -1 1 0.2  1 1 -0.4 ] " + normals,
      "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2  1 3 2 ] \"point3 P\" [ -1 -1 0  1 -1 0.3  -1 1 0.2  1 1 "
      "-0.4 "
      "] " +
          normals};
  for (const std::string& shape : shapes) {
    expect_derivative(shape);
    expect_derivative("ReverseOrientation\n" + shape);
    expect_derivative("Rotate 20 1 0.4 0\nScale 1.3 0.9 1.1\n" + shape);
    expect_derivative("ObjectBegin \"o\"\nRotate 25 0 1 0\n" + shape +
                      "ObjectEnd\nScale -1.2 1 0.8\nObjectInstance \"o\"\n");
    expect_derivative(moving + shape, 0.4f);
  }
}

TEST(NormalGradient, of_triangles_without_normals_is_zero) {
  const TestScene scene(head +
                        "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2  1 3 2 ] \"point3 P\" [ -1 -1 0  1 -1 0.3  "
                        "-1 1 0.2  1 1 -0.4 ]\n");
  const Met here = meet(scene, {0.2f, 0.1f, -5}, {0, 0, 1}, 0);
  const NormalGradient gradient = normal_gradient(scene.scene().geometry, here.hit, here.x.point.p, here.x.point.ns, 0);
  EXPECT_EQ(norm(gradient.along({1, 2, 3})), 0);
}

}  // namespace
}  // namespace montelux::test
