// Motion vectors against ways that are known.
#include "render/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render_scenes.h"

namespace montelux::test {
namespace {

PixelBuffer motion(const TestScene& scene, Shutter now, Shutter before, int threads = 1) {
  const PictureSettings& p = scene.picture();
  return motion_vectors(scene.scene(), scene.accel(), {{0, 0, p.width, p.height}, now, before, threads});
}

// Over the whole time a square goes two units to the right and one up, which are 16 and 8 pixels.
const char* const sliding = R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
LookAt 0 0 -5  0 0 0  0 1 0
Camera "orthographic"
WorldBegin
LightSource "infinite"
ActiveTransform EndTime
Translate 2 1 0
ActiveTransform All
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ -2 -2 0   0 -2 0   0 0.25 0   -2 0.25 0 ]
)";

TEST(MotionVectors, lead_back_along_the_way_of_a_thing_that_slides) {
  const TestScene scene(sliding);
  // Half-way through the exposures: at 0.5 and 0.25.
  const PixelBuffer m = motion(scene, {0.4f, 0.6f}, {0.25f, 0.25f}, 3);
  int moved = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      // Then the square covers x from -1 to 1 and y from -1.5 to 0.75, and the sky is above it.
      const bool inside = y >= 2;
      EXPECT_NEAR(m.at(x, y, 0), inside ? -4 : 0, 1e-4f) << x << " " << y;
      EXPECT_NEAR(m.at(x, y, 1), inside ? -2 : 0, 1e-4f) << x << " " << y;
      moved += inside;
    }
  EXPECT_EQ(moved, 16 * 14);
}

TEST(MotionVectors, of_the_sky_are_those_of_the_turning_camera) {
  // Five degrees about the upward axis, to the right.
  const TestScene scene(R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 32
LookAt 0 0 0  0 0 1  0 1 0
ActiveTransform EndTime
Rotate -10 0 1 0
ActiveTransform All
Camera "perspective" "float fov" 90
WorldBegin
LightSource "infinite"
)");
  const PixelBuffer m = motion(scene, {0.5f, 0.5f}, {0, 0});
  const double turn = 5 * std::numbers::pi / 180;
  for (int x = 0; x < 32; ++x) {
    const double now = std::atan((x + 0.5 - 16) / 16), then = 16 + 16 * std::tan(now + turn);
    // The camera turns by the angle itself, not by chords, so that rounding alone is left: directions to about 1e-7,
    // which the picture stretches by 16 (1 + tan^2) < 40, and places up to 38 to 2e-6.
    EXPECT_NEAR(m.at(x, 16, 0), then - (x + 0.5), 1e-5) << x;
  }
  EXPECT_EQ(motion(scene, {0.5f, 0.5f}, {0.4f, 0.6f}).at(3, 3, 0),
            motion(scene, {0.5f, 0.5f}, {0.5f, 0.5f}).at(3, 3, 0));
}

// All around: also where the way leads over the seam of the picture.
TEST(MotionVectors, of_a_panorama_are_the_shorter_way_round) {
  const TestScene scene(R"(Film "rgb" "integer xresolution" 36 "integer yresolution" 18
LookAt 0 0 0  0 0 1  0 1 0
ActiveTransform EndTime
Rotate -20 0 1 0
ActiveTransform All
Camera "spherical" "string mapping" [ "equirectangular" ]
WorldBegin
LightSource "infinite"
)");
  // Ten degrees, which are one pixel of the picture, the same way everywhere.
  const PixelBuffer m = motion(scene, {0.5f, 0.5f}, {0, 0});
  EXPECT_NEAR(std::abs(m.at(18, 9, 0)), 1, 1e-4);
  for (int x = 0; x < 36; ++x) EXPECT_NEAR(m.at(x, 9, 0), m.at(18, 9, 0), 1e-4) << x;
}

}  // namespace
}  // namespace montelux::test
