// A panorama that takes the place of a scene's own environment.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "gltf_files.h"
#include "io/scene_file.h"
#include "scene/prepare.h"

namespace montelux {
namespace {

using namespace test;

// An image of one colour except for one texel, rows from the top, in the portable float format (rows from the bottom).
std::string picture(int width, int height, int bright_x, int bright_y) {
  std::string text = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
  for (int y = height - 1; y >= 0; --y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        const float value = x == bright_x && y == bright_y ? 100.0f : 1.0f;
        char raw[4];
        std::memcpy(raw, &value, 4);
        text.append(raw, 4);
      }
  return text;
}

struct Lit {
  std::optional<PreparedScene> scene;
  std::string said;
  float radiance(Vec3f d) const { return scene->scene.lights.escaped_radiance<float>(normalize(d), true)[0]; }
};

Lit lit(const std::string& scene_file, const Environment& environment) {
  ReadOptions options;
  options.environment = environment;
  ReadResult read = read_scene(scene_file, options);
  Lit result;
  if (read.scene) result.scene = prepare(*read.scene, {}, read.diagnostics);
  result.said = render(read.diagnostics);
  return result;
}

class EnvironmentImage : public testing::Test {
 protected:
  TemporaryFolder folder;
  std::string pbrt = folder.write("a.pbrt", "WorldBegin LightSource \"infinite\" \"rgb L\" [ 7 7 7 ] Shape \"sphere\"");
  std::string gltf = folder.write("a.gltf", triangle_json());
};

// Column u shows the azimuth atan2(z, x) = 2 pi u, row v the angle acos(y) = pi v.
TEST_F(EnvironmentImage, lies_as_it_is_documented_in_every_format) {
  // 64 by 32: the texel at (16, 15) is around u = 1/4 and v = 1/2: +z.
  const std::string toward_z = folder.write("z.pfm", picture(64, 32, 16, 15));
  const std::string toward_x = folder.write("x.pfm", picture(64, 32, 0, 15));
  for (const std::string& scene : {pbrt, gltf}) {
    const Lit z = lit(scene, {toward_z}), x = lit(scene, {toward_x});
    ASSERT_TRUE(z.scene && x.scene) << z.said << x.said;
    const Vec3f at_z{-0.05f, 0.05f, 1}, at_x{1, 0.05f, 0.05f};
    EXPECT_GT(z.radiance(at_z), 50);
    EXPECT_GT(x.radiance(at_x), 50);
    EXPECT_EQ(z.radiance(at_x), 1);
    EXPECT_EQ(x.radiance(at_z), 1);
    EXPECT_EQ(x.radiance({-1, 0.05f, 0.05f}), 1);
    EXPECT_EQ(x.said.find("no light"), std::string::npos);
  }
}

TEST_F(EnvironmentImage, of_equal_areas_has_its_middle_on_top) {
  const Lit up = lit(pbrt, {folder.write("up.pfm", picture(33, 33, 16, 16))});
  ASSERT_TRUE(up.scene) << up.said;
  EXPECT_EQ(up.radiance({0, 1, 0}), 100);
  EXPECT_EQ(up.radiance({0, -1, 0}), 1);
  EXPECT_EQ(up.radiance({1, 0, 0}), 1);
  const Lit along = lit(pbrt, {folder.write("x.pfm", picture(33, 33, 24, 24))});
  // The azimuth 45 degrees, from +x toward +z.
  EXPECT_EQ(along.radiance({1, 0, 1}), 100);
}

TEST_F(EnvironmentImage, is_turned_and_scaled) {
  const std::string toward_x = folder.write("x.pfm", picture(64, 32, 0, 15));
  const Lit turned = lit(pbrt, {toward_x, 90, 0.5});
  ASSERT_TRUE(turned.scene) << turned.said;
  EXPECT_GT(turned.radiance({-0.05f, 0.05f, 1}), 25);
  EXPECT_EQ(turned.radiance({1, 0.05f, 0.05f}), 0.5f);
}

TEST_F(EnvironmentImage, takes_the_place_of_the_scenes_own) {
  const std::string image = folder.write("x.pfm", picture(64, 32, 0, 15));
  const Lit result = lit(pbrt, {image});
  ASSERT_TRUE(result.scene);
  EXPECT_EQ(result.scene->scene.lights.infinite_count(), 1);
  EXPECT_NE(result.said.find("replaces the scene's own one"), std::string::npos) << result.said;
}

TEST_F(EnvironmentImage, that_cannot_be_used_is_refused) {
  EXPECT_FALSE(lit(pbrt, {folder.path() + "/none.exr"}).scene);
  EXPECT_NE(lit(pbrt, {folder.path() + "/none.exr"}).said.find("none.exr: error: there is no file"), std::string::npos);
  const Lit odd = lit(pbrt, {folder.write("odd.pfm", picture(30, 20, 0, 0))});
  EXPECT_FALSE(odd.scene);
  EXPECT_NE(odd.said.find("square (equal-area) or twice as wide as high"), std::string::npos) << odd.said;
  EXPECT_FALSE(lit(pbrt, {folder.write("text.exr", "no picture")}).scene);
}

}  // namespace
}  // namespace montelux
