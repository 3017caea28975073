// Animations of glTF: tracks against closed forms, and what the description makes of them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "gltf_files.h"
#include "io/gltf/animations.h"

namespace montelux {
namespace {

using namespace test;
using gltf::AnimatedPath;
using gltf::Interpolation;
using gltf::Track;

constexpr double pi2 = std::numbers::pi / 2;

// About z.
std::vector<float> turn(double angle) { return {0, 0, float(std::sin(angle / 2)), float(std::cos(angle / 2))}; }

std::vector<float> joined(std::initializer_list<std::vector<float>> parts) {
  std::vector<float> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(GltfTrack, of_steps_holds_each_value_until_the_next_key) {
  const Track track{0, AnimatedPath::translation, Interpolation::step, {1, 2, 4}, 3, {1, 0, 0, 2, 0, 0, 3, 0, 0}};
  EXPECT_EQ(track.at(0)[0], 1);
  EXPECT_EQ(track.at(1.99)[0], 1);
  EXPECT_EQ(track.at(2)[0], 2);
  EXPECT_EQ(track.at(3.9)[0], 2);
  EXPECT_EQ(track.at(9)[0], 3);
}

TEST(GltfTrack, of_lines_goes_straight_and_stands_beyond_its_keys) {
  const Track track{0, AnimatedPath::scale, Interpolation::linear, {1, 3}, 3, {1, 2, 3, 5, 4, 3}};
  EXPECT_NEAR(track.at(1.5)[0], 2, 1e-12);
  EXPECT_NEAR(track.at(2.5)[1], 3.5, 1e-12);
  EXPECT_EQ(track.at(-1)[0], 1);
  EXPECT_EQ(track.at(7)[0], 5);
}

TEST(GltfTrack, of_rotations_turns_at_constant_speed_along_the_shorter_arc) {
  // From 0 to 120 degrees; the quaternion of the end has the other sign.
  std::vector<float> end = turn(4 * pi2 / 3);
  for (float& x : end) x = -x;
  const Track track{0, AnimatedPath::rotation, Interpolation::linear, {0, 2}, 4, joined({turn(0), end})};
  for (double t : {0.25, 0.5, 1.0, 1.75}) {
    const std::vector<double> q = track.at(t);
    const double angle = t / 2 * 4 * pi2 / 3;
    EXPECT_NEAR(q[2], std::sin(angle / 2), 1e-7) << t;
    EXPECT_NEAR(q[3], std::cos(angle / 2), 1e-7) << t;
  }
}

TEST(GltfTrack, of_a_cubic_spline_is_the_cubic_that_its_tangents_state) {
  // x(t) = t^3 - 2 t over [1, 3]: values -1 and 21, slopes 1 and 25.
  const Track track{0,
                    AnimatedPath::translation,
                    Interpolation::cubic,
                    {1, 3},
                    3,
                    {0, 0, 0, -1, 0, 0, 1, 0, 0, 25, 0, 0, 21, 0, 0, 0, 0, 0}};
  for (double t : {1.0, 1.3, 2.0, 2.9, 3.0}) EXPECT_NEAR(track.at(t)[0], t * t * t - 2 * t, 1e-9) << t;
  EXPECT_EQ(track.at(0)[0], -1);
}

// The triangle, with these keys.
std::string animated(const std::vector<float>& times, const std::vector<float>& values, const std::string& path,
                     const std::string& interpolation = "LINEAR", const std::string& node = R"("mesh": 0)",
                     const std::string& more = "") {
  Bytes bytes = triangle_bytes();
  for (const auto* all : {&times, &values})
    for (const float x : *all) bytes.put<float>({x});
  const bool four = path == "rotation";
  std::string json = triangle_json(
      R"("attributes": {"POSITION": 0}, "indices": 1)", node,
      R"(, "animations": [{"name": "spin", "samplers": [{"input": 2, "output": 3, "interpolation": ")" + interpolation +
          R"("}], "channels": [{"sampler": 0, "target": {"node": 0, "path": ")" + path + R"("}}]}])" + more,
      buffers_of(bytes));
  const auto replace = [&](const std::string& from, const std::string& to) {
    json.replace(json.find(from), from.size(), to);
  };
  const auto bytes_of = [](const std::vector<float>& v) { return std::to_string(4 * v.size()); };
  replace(R"("byteOffset": 36, "byteLength": 6})",
          R"("byteOffset": 36, "byteLength": 6}, {"buffer": 0, "byteOffset": 44, "byteLength": )" + bytes_of(times) +
              R"(}, {"buffer": 0, "byteOffset": )" + std::to_string(44 + 4 * times.size()) + R"(, "byteLength": )" +
              bytes_of(values) + "}");
  replace(R"("type": "SCALAR"}], )",
          R"("type": "SCALAR"}, {"bufferView": 2, "componentType": 5126, "type": "SCALAR", "count": )" +
              std::to_string(times.size()) + R"(}, {"bufferView": 3, "componentType": 5126, "count": )" +
              std::to_string(values.size() / (four ? 4 : 3)) + R"(, "type": ")" + (four ? "VEC4" : "VEC3") + "\"}], ");
  return json;
}

// The triangle, over two seconds turned by `angle` about z, or moved along x.
std::string turning(double angle, const std::string& path = "rotation", const std::string& interpolation = "LINEAR",
                    const std::string& node = R"("mesh": 0)", const std::string& more = "") {
  const std::vector<float> values =
      path == "rotation" ? joined({turn(0), turn(angle)}) : std::vector<float>{0, 0, 0, float(angle), 0, 0};
  return animated({0, 2}, values, path, interpolation, node, more);
}
// The same by a key for each quarter of a turn.
std::string turning_by_quarters(int quarters) {
  std::vector<float> times, values;
  for (int i = 0; i <= quarters; ++i) {
    times.push_back(2.0f * float(i) / float(quarters));
    for (const float x : turn(pi2 * i)) values.push_back(x);
  }
  return animated(times, values, "rotation");
}

ReadResult read_window(const std::string& json, AnimationWindow window, bool lenient = false) {
  ReadOptions options;
  options.lenient = lenient;
  options.window = [window](const AnimationTime& time) {
    EXPECT_EQ(time.start, 0);
    EXPECT_EQ(time.end, 2);
    return window;
  };
  return read_text(json, options);
}

ReadResult read_text_in(AnimationWindow window, const std::string& json, bool lenient = false) {
  ReadOptions options;
  options.lenient = lenient;
  options.window = [window](const AnimationTime&) { return window; };
  return read_text(json, options);
}

TEST(GltfAnimation, stands_at_its_start_in_a_still_picture) {
  const ReadResult result = read_text(turning(pi2));
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  EXPECT_TRUE(result.scene->shapes.at(0).object_to_world_later.empty());
  EXPECT_NEAR(result.scene->shapes[0].object_to_world.point(Vec3f{2, 0, 0}).x, 2, 1e-6);
}

TEST(GltfAnimation, has_the_moments_of_the_frames_where_the_shutter_is_closed) {
  // Frames at 0.5, 1, 1.5, 2 s.
  const ReadResult result = read_window(turning(2 * pi2 * 0.9), {0.5, 2, 3, false});
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  const ShapeDesc& shape = result.scene->shapes.at(0);
  EXPECT_EQ(result.scene->transforms_start, 0.5);
  EXPECT_EQ(result.scene->transforms_end, 2);
  ASSERT_EQ(shape.object_to_world_later.size(), 3u);
  for (std::size_t k = 0; k < 4; ++k) {
    const Transform& t = k == 0 ? shape.object_to_world : shape.object_to_world_later[k - 1];
    const double angle = (0.5 + 0.5 * double(k)) / 2 * 2 * pi2 * 0.9;
    EXPECT_NEAR(t.point(Vec3f{1, 0, 0}).x, std::cos(angle), 1e-6);
    EXPECT_NEAR(t.point(Vec3f{1, 0, 0}).y, std::sin(angle), 1e-6);
  }
  ASSERT_TRUE(result.scene->shutter);
  EXPECT_EQ(result.scene->shutter->first, result.scene->shutter->second);
}

TEST(GltfAnimation, has_as_many_moments_as_straight_lines_need_while_the_shutter_is_open) {
  const ReadResult result = read_window(turning(pi2), {0, 0.5, 1, true});
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  const ShapeDesc& shape = result.scene->shapes.at(0);
  const std::size_t steps = shape.object_to_world_later.size();
  // A step of a quarter of the way: angle^2 / 8 of the distance from the axis.
  const double step = pi2 / 4 / double(steps);
  EXPECT_LE(step * step / 8, 1.3e-5);
  EXPECT_LE(steps, 128u);
}

TEST(GltfAnimation, that_is_too_fast_for_its_steps_holds_fewer_frames_or_is_refused) {
  // 0.9 of half a turn in 2 s, in 100 frames of 0.02 s with an open shutter, takes two chords a frame.
  const ReadResult slow = read_window(turning(2 * pi2 * 0.9), {0, 2, 100, true});
  ASSERT_TRUE(slow.scene);
  EXPECT_EQ(slow.scene->frames_held, 63);
  const ReadResult many = read_window(turning(pi2), {0, 2, 500, false});
  ASSERT_TRUE(many.scene);
  EXPECT_EQ(many.scene->frames_held, 127);
  EXPECT_EQ(many.scene->shapes.at(0).object_to_world_later.size(), 128u);
  EXPECT_NEAR(many.scene->transforms_end, 2 * 128.0 / 500, 1e-9);
  // A jump with the shutter open.
  const ReadResult jump = read_window(turning(pi2, "rotation", "STEP"), {0, 2.5, 1, true});
  EXPECT_FALSE(jump.scene);
  EXPECT_NE(render(jump.diagnostics).find("too fast"), std::string::npos) << render(jump.diagnostics);
}

// The largest deviation of a turn from its chords, over all steps.
double sag(const ReadResult& result, double turn_in_all, double time_in_all) {
  const double step = turn_in_all * (result.scene->transforms_end - result.scene->transforms_start) / time_in_all /
                      double(result.scene->shapes.at(0).object_to_world_later.size());
  return 1 - std::cos(step / 2);
}

TEST(GltfAnimation, is_followed_in_all_the_frames_that_are_held) {
  const double turn = pi2 * 0.9;
  // Steps between 100 frames in 2 s, more frames than there are moments, and exposures of two and a half frames.
  for (const AnimationWindow window :
       {AnimationWindow{0, 2, 100, true, 0.5}, {0, 2, 300, true, 0.9}, {0, 2, 60, true, 2.5}}) {
    const ReadResult result = read_window(turning(2 * turn), window);
    ASSERT_TRUE(result.scene) << render(result.diagnostics);
    const int steps = int(result.scene->shapes.at(0).object_to_world_later.size());
    EXPECT_LE(steps, 128);
    EXPECT_LE(sag(result, 2 * turn, 2), 7.6e-5);
    // Whole exposures lie within what is held.
    const int held = std::min(result.scene->frames_held, window.intervals);
    const double interval = 2.0 / window.intervals;
    EXPECT_GE(held, 4);
    if (held < window.intervals) {
      EXPECT_LE((held + window.exposure) * interval, result.scene->transforms_end + 1e-9);
    }
  }
}

// What ends where it began, and what slides, is seen to move.
TEST(GltfAnimation, that_comes_back_within_the_exposure_is_followed) {
  // Two whole turns, of which start, middle and end look the same.
  const ReadResult turns = read_window(turning_by_quarters(8), {0, 2, 1, true});
  EXPECT_FALSE(turns.scene);  // 128 steps do not follow that much
  EXPECT_NE(render(turns.diagnostics).find("too fast"), std::string::npos);
  const ReadResult slow = read_window(turning_by_quarters(8), {0, 2, 20, true, 1});
  ASSERT_TRUE(slow.scene) << render(slow.diagnostics);
  // A jump far ahead is reported at once, with its time.
  const std::string jumps = animated({0, 1.7f, 1.75f}, joined({turn(0), turn(0), turn(1)}), "rotation", "STEP");
  const ReadResult ahead = read_text_in({0, 1.75, 60, true, 0.5}, jumps);
  EXPECT_FALSE(ahead.scene);
  EXPECT_NE(render(ahead.diagnostics).find("at 1.72"), std::string::npos) << render(ahead.diagnostics);
  // Where that is tolerated, the frames before it do not suffer.
  const ReadResult tolerated = read_text_in({0, 1.75, 60, true, 0.5}, jumps, true);
  ASSERT_TRUE(tolerated.scene);
  EXPECT_GE(tolerated.scene->frames_held, 60);
  // There and back, by keys at 0, 1 and 2 s.
  const ReadResult slides =
      read_window(animated({0, 1, 2}, {0, 0, 0, 4, 0, 0, 0, 0, 0}, "translation"), {0, 2, 1, true});
  ASSERT_TRUE(slides.scene) << render(slides.diagnostics);
  const auto& later = slides.scene->shapes.at(0).object_to_world_later;
  ASSERT_GE(later.size(), 2u);
  EXPECT_NEAR(later.at(later.size() / 2 - 1).point(Vec3f{0, 0, 0}).x, 4, 1e-5);
  EXPECT_NEAR(later.back().point(Vec3f{0, 0, 0}).x, 0, 1e-5);
}

TEST(GltfAnimation, names_the_keys_that_are_wrong) {
  const struct {
    std::string json, words;
  } faults[] = {
      {animated({0, 2, 1}, {0, 0, 0, 1, 0, 0, 2, 0, 0}, "translation"), "key 2 is at 1.0"},
      {animated({0, 1, 1}, {0, 0, 0, 1, 0, 0, 2, 0, 0}, "translation"), "the previous one at 1.0"},
      {animated({-1, 2}, {0, 0, 0, 1, 0, 0}, "translation"), "key 0 is at -1.0"},
      {animated({0, 2}, {0, 0, 0, 1, 0, 0, 2, 0, 0}, "translation"), "has 3 values for 2 keys"},
      {animated({0, 2}, {0, 0, 0, 1, 0, 0}, "translation", "CUBICSPLINE"), "which need three each"},
      {animated({0, 2}, {0, 0, 0, 1, 0, 0, 0, 0}, "rotation"), "the rotation of key 1 has length zero"},
      {animated({0, 2}, {0, 0, 0, 1, 0, 0}, "translation", "LINEAR",
                R"("mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])"),
       "has a matrix, which cannot be animated"},
      {animated({0, 2}, {0, 0, 0, 1, 0, 0}, "translation", "LINEER"), "did you mean \"LINEAR\""},
  };
  for (const auto& fault : faults) {
    const ReadResult result = read_text(fault.json);
    EXPECT_FALSE(result.scene) << fault.words;
    EXPECT_NE(render(result.diagnostics).find(fault.words), std::string::npos) << fault.words << "\n"
                                                                               << render(result.diagnostics);
  }
}

TEST(GltfAnimation, moves_cameras) {
  const ReadResult result =
      read_window(turning(4, "translation", "LINEAR", R"("camera": 0}, {"mesh": 0)",
                          R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 1}}])"),
                  {0, 2, 2, false});
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  ASSERT_EQ(result.scene->world_to_camera_later.size(), 2u);
  EXPECT_NEAR(result.scene->world_to_camera_later[0].point(Vec3f{0, 0, -1}).x, -2, 1e-6);
  EXPECT_NEAR(result.scene->world_to_camera_later[1].point(Vec3f{0, 0, -1}).x, -4, 1e-6);
}

TEST(GltfAnimation, of_lights_is_refused_or_left_at_its_start) {
  const std::string lamp =
      turning(4, "translation", "LINEAR", R"("mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}})",
              R"(, "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}})");
  const ReadResult result = read_window(lamp, {0, 2, 2, false});
  EXPECT_FALSE(result.scene);
  EXPECT_NE(render(result.diagnostics).find("a light moves"), std::string::npos) << render(result.diagnostics);
  const ReadResult lenient = read_window(lamp, {0, 2, 2, false}, true);
  ASSERT_TRUE(lenient.scene);
  EXPECT_NEAR(lenient.scene->lights.at(0).light_to_world.point(Vec3f{0, 0, 0}).x, 0, 1e-6);
}

TEST(GltfAnimation, is_chosen_by_name_or_number) {
  ReadOptions options;
  options.animation = "spin";
  EXPECT_TRUE(read_text(turning(pi2), options).scene);
  options.animation = "0";
  EXPECT_TRUE(read_text(turning(pi2), options).scene);
  options.animation = "spon";
  const ReadResult wrong = read_text(turning(pi2), options);
  EXPECT_FALSE(wrong.scene);
  EXPECT_NE(render(wrong.diagnostics).find("did you mean 'spin'"), std::string::npos);
}

// The triangle with a skin of two joints (nodes 1 and 2) and a morph target that lifts its last corner by one.
std::string deforming(const std::string& path, bool skinned) {
  Bytes bytes = triangle_bytes();                                 // 0: positions, 36: indices
  bytes.put<float>({0, 2});                                       // 44: times
  bytes.put<float>({0, 0, 0, 0, 0, 0, 0, 1, 0});                  // 52: target
  bytes.put<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});  // 88: joints
  bytes.put<float>({1, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0.5f, 0, 0});   // 100: weights
  bytes.put<float>({0, 1});                                       // 148: weights of the target
  bytes.put<float>({0, 0, 0, 4, 0, 0});                           // 156: translations
  std::string json = triangle_json(
      std::string(R"("attributes": {"POSITION": 0)") + (skinned ? R"(, "JOINTS_0": 4, "WEIGHTS_0": 5)" : "") +
          R"(}, "indices": 1, "targets": [{"POSITION": 3}])",
      std::string(R"("mesh": 0, "translation": [0, 0, 7])") + (skinned ? R"(, "skin": 0)" : "") +
          R"(, "children": [1, 2]}, {"name": "a"}, {"name": "b")",
      R"(, "skins": [{"joints": [1, 2]}], "animations": [{"samplers": [{"input": 2, "output": )" +
          std::string(path == "weights" ? "6" : "7") + R"(}], "channels": [{"sampler": 0, "target": {"node": )" +
          (path == "weights" ? "0" : "2") + R"(, "path": ")" + path + R"("}}]}])",
      buffers_of(bytes));
  const auto replace = [&](const std::string& from, const std::string& to) {
    json.replace(json.find(from), from.size(), to);
  };
  std::string views = R"("byteOffset": 36, "byteLength": 6})", accessors = R"("type": "SCALAR"})";
  const struct {
    int offset, length, type, count;
    const char* shape;
  } parts[] = {{44, 8, 5126, 2, "SCALAR"}, {52, 36, 5126, 3, "VEC3"},   {88, 12, 5121, 3, "VEC4"},
               {100, 48, 5126, 3, "VEC4"}, {148, 8, 5126, 2, "SCALAR"}, {156, 24, 5126, 2, "VEC3"}};
  int view = 2;
  for (const auto& p : parts) {
    views += R"(, {"buffer": 0, "byteOffset": )" + std::to_string(p.offset) + R"(, "byteLength": )" +
             std::to_string(p.length) + "}";
    accessors += R"(, {"bufferView": )" + std::to_string(view++) + R"(, "componentType": )" + std::to_string(p.type) +
                 R"(, "count": )" + std::to_string(p.count) + R"(, "type": ")" + p.shape + "\"}";
  }
  replace(R"("byteOffset": 36, "byteLength": 6})", views);
  replace(R"("type": "SCALAR"})", accessors);
  return json;
}

TEST(GltfAnimation, of_morph_targets_makes_poses_of_the_mesh) {
  const ReadResult result = read_window(deforming("weights", false), {0, 2, 4, false});
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  const Mesh& mesh = *mesh_of(result.scene->shapes.at(0));
  ASSERT_EQ(mesh.later.size(), 4u);
  EXPECT_FLOAT_EQ(mesh.positions[2].y, 3);
  EXPECT_FLOAT_EQ(mesh.positions[2].z, 7);  // in the world
  for (std::size_t k = 0; k < 4; ++k) EXPECT_FLOAT_EQ(mesh.later[k].positions[2].y, 3 + 0.25f * float(k + 1));
}

TEST(GltfAnimation, of_joints_moves_vertices_by_their_weights) {
  // Joints are children of the mesh's node, which is at z = 7; the second goes to x = 4.
  const ReadResult result = read_window(deforming("translation", true), {0, 2, 2, false});
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  const Mesh& mesh = *mesh_of(result.scene->shapes.at(0));
  ASSERT_EQ(mesh.later.size(), 2u);
  const std::vector<Vec3f>& end = mesh.later[1].positions;
  EXPECT_NEAR(mesh.positions[0].z, 7, 1e-6);
  EXPECT_NEAR(end[0].x, 0, 1e-6);      // of the first joint
  EXPECT_NEAR(end[1].x, 2 + 4, 1e-6);  // of the second
  EXPECT_NEAR(end[2].x, 0 + 2, 1e-6);  // of both by half
  EXPECT_NEAR(mesh.later[0].positions[1].x, 2 + 2, 1e-6);
}

}  // namespace
}  // namespace montelux
