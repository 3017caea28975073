// Motion vectors in scenes of glTF whose animations are known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "gltf_files.h"
#include "render/motion.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

using namespace test;

// A square of two units in the picture of four, 16 x 16 pixels; its animation of two seconds is of this path.
std::string square(const std::string& path, const std::string& shape, const Bytes& animated) {
  Bytes bytes;
  bytes.put<float>({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}).put<std::uint16_t>({0, 1, 2, 0, 2, 3}).put<float>({0, 2});
  const std::string data = bytes.text() + animated.text();
  return R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "cameras": [{"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 2, "znear": 0.1, "zfar": 9}}],
    "animations": [{"samplers": [{"input": 2, "output": 3}], "channels": [{"sampler": 0, "target": {"node": 0,
    "path": ")" +
         path + R"("}}]}],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12},
      {"buffer": 0, "byteOffset": 60, "byteLength": 8}, {"buffer": 0, "byteOffset": 68, "byteLength": )" +
         std::to_string(animated.size()) + R"(}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
      {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR"},
      {"bufferView": 3, "componentType": 5126, "count": 2, "type": ")" +
         shape + R"("}],
    "buffers": [{"byteLength": )" +
         std::to_string(data.size()) + R"(, "uri": "data:;base64,)" + base64(data) + R"("}]})";
}

// From the frame at half a second to that at one second, of the frames at 0, 0.5, 1, 1.5 and 2.
PixelBuffer motion_of_frame(const std::string& json) {
  ReadOptions options;
  options.window = [](const AnimationTime&) { return AnimationWindow{0, 2, 4, false}; };
  const TestScene scene(test::read_text(json, options), std::pair{16, 16});
  return motion_vectors(scene.scene(), scene.accel(), {{0, 0, 16, 16}, {0.5f, 0.5f}, {0.25f, 0.25f}, 1});
}

TEST(GltfMotionVectors, lead_back_along_a_slide) {
  // Four units to the right and two up in two seconds: in half a second 4 and 2 pixels.
  const PixelBuffer m = motion_of_frame(square("translation", "VEC3", Bytes().put<float>({-2, -1, 0, 2, 1, 0})));
  EXPECT_NEAR(m.at(8, 8, 0), -4, 1e-3);
  EXPECT_NEAR(m.at(8, 8, 1), -2, 1e-3);  // y upward
  EXPECT_NEAR(m.at(1, 1, 0), 0, 1e-3);
}

TEST(GltfMotionVectors, lead_back_along_a_turn_of_any_angle) {
  // 160 degrees, counter-clockwise, in two seconds: 40 in half a second, between moments that are exact.
  const double half = 80 * std::numbers::pi / 180, turn = 40 * std::numbers::pi / 180;
  const PixelBuffer m = motion_of_frame(
      square("rotation", "VEC4", Bytes().put<float>({0, 0, 0, 1, 0, 0, float(std::sin(half)), float(std::cos(half))})));
  for (int y = 6; y <= 9; ++y)
    for (int x = 6; x <= 9; ++x) {
      // From the middle of the picture, y upward.
      const double px = x + 0.5 - 8, py = 8 - (y + 0.5);
      EXPECT_NEAR(m.at(x, y, 0), std::cos(turn) * px + std::sin(turn) * py - px, 1e-3);
      EXPECT_NEAR(m.at(x, y, 1), std::cos(turn) * py - std::sin(turn) * px - py, 1e-3);
    }
}

}  // namespace
}  // namespace montelux::test
