// The parts of a glTF document after reading, compared with the specification.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "gltf_files.h"
#include "io/scene_file.h"
#include "scene/prepare.h"

namespace montelux {
namespace {

using namespace test;

// A document with one mesh of one primitive whose accessors are given.
std::string mesh_json(const Bytes& bytes, const std::string& views, const std::string& accessors,
                      const std::string& primitive) {
  return R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{)" + primitive +
         R"(}]}], "bufferViews": [)" + views + R"(], "accessors": [)" + accessors + "], " + buffers_of(bytes) + "}";
}

const Mesh& only_mesh(const ReadResult& result) {
  EXPECT_TRUE(result.scene) << render(result.diagnostics);
  EXPECT_EQ(result.scene->shapes.size(), 1u);
  return *mesh_of(result.scene->shapes.at(0));
}

void expect_point(Vec3f p, double x, double y, double z, double tolerance = 1e-5) {
  EXPECT_NEAR(p.x, x, tolerance);
  EXPECT_NEAR(p.y, y, tolerance);
  EXPECT_NEAR(p.z, z, tolerance);
}

TEST(GltfMesh, is_read_with_its_indices) {
  const ReadResult result = read_text(triangle_json());
  const Mesh& mesh = only_mesh(result);
  ASSERT_EQ(mesh.positions.size(), 3u);
  expect_point(mesh.positions[2], 0, 3, 0);
  EXPECT_EQ(mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_TRUE(mesh.normals.empty());  // flat
}

TEST(GltfMesh, has_every_type_of_component) {
  // The corner (1, 0, 0) of a triangle as bytes, shorts and so on, normalised.
  const auto positions = [](int type, auto one, const char* normalized) {
    using T = decltype(one);
    Bytes bytes;
    for (const auto& p : {std::array<T, 3>{0, 0, 0}, {one, 0, 0}, {0, one, 0}}) bytes.put<T>({p[0], p[1], p[2]}).pad();
    const std::string stride = std::to_string(bytes.size() / 3), size = std::to_string(bytes.size());
    const ReadResult result =
        read_text(mesh_json(bytes, R"({"buffer": 0, "byteLength": )" + size + R"(, "byteStride": )" + stride + "}",
                            R"({"bufferView": 0, "componentType": )" + std::to_string(type) +
                                R"(, "count": 3, "type": "VEC3", "normalized": )" + normalized + "}",
                            R"("attributes": {"POSITION": 0})"));
    return only_mesh(result).positions;
  };
  EXPECT_EQ(positions(5120, std::int8_t(127), "true")[1].x, 1);
  EXPECT_EQ(positions(5121, std::uint8_t(255), "true")[1].x, 1);
  EXPECT_EQ(positions(5122, std::int16_t(32767), "true")[1].x, 1);
  EXPECT_EQ(positions(5123, std::uint16_t(65535), "true")[1].x, 1);
  EXPECT_EQ(positions(5120, std::int8_t(-128), "true")[1].x, -1);  // clamped
  EXPECT_EQ(positions(5122, std::int16_t(-7), "false")[1].x, -7);
  EXPECT_EQ(positions(5125, std::uint32_t(70000), "false")[1].x, 70000);
  EXPECT_EQ(positions(5126, 0.25f, "false")[1].x, 0.25f);
}

TEST(GltfMesh, may_lie_interleaved_and_partly_in_a_sparse_part) {
  // Position and normal in turn; of vertex 1 the sparse part has another position.
  Bytes bytes;
  bytes.put<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1});
  bytes.put<std::uint8_t>({1}).pad().put<float>({5, 0, 0});
  const ReadResult result = read_text(
      mesh_json(bytes,
                R"({"buffer": 0, "byteLength": 72, "byteStride": 24}, {"buffer": 0, "byteOffset": 72, "byteLength": 4},
         {"buffer": 0, "byteOffset": 76, "byteLength": 12})",
                R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 1,
          "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 2}}},
         {"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 3, "type": "VEC3"})",
                R"("attributes": {"POSITION": 0, "NORMAL": 1})"));
  const Mesh& mesh = only_mesh(result);
  EXPECT_EQ(mesh.positions[1].x, 5);
  EXPECT_EQ(mesh.positions[2].y, 1);
  ASSERT_EQ(mesh.normals.size(), 3u);
  EXPECT_EQ(mesh.normals[1].z, 1);
}

TEST(GltfMesh, may_be_a_strip_or_a_fan) {
  // A fan around the first vertex, with which a strip has area, too.
  Bytes bytes;
  bytes.put<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0.5f, 2, 0, -1, 1, 0});
  const auto triangles = [&](int mode) {
    const ReadResult result =
        read_text(mesh_json(bytes, R"({"buffer": 0, "byteLength": 60})",
                            R"({"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3"})",
                            R"("attributes": {"POSITION": 0}, "mode": )" + std::to_string(mode)));
    return only_mesh(result).triangles;
  };
  EXPECT_EQ(triangles(5), (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(triangles(6), (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
  EXPECT_EQ(triangles(4), (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(GltfMesh, of_points_or_lines_is_left_out_with_a_warning) {
  const ReadResult result = read_text(triangle_json(R"("attributes": {"POSITION": 0}, "mode": 1)"));
  ASSERT_TRUE(result.scene);
  EXPECT_TRUE(result.scene->shapes.empty());
  EXPECT_NE(render(result.diagnostics).find("points and lines"), std::string::npos);
}

TEST(GltfNode, is_translated_after_it_is_turned_after_it_is_scaled) {
  // A quarter turn about z: (2, 0, 0) -> scaled (4, 0, 0) -> turned (0, 4, 0) -> moved.
  const ReadResult result = read_text(triangle_json(R"("attributes": {"POSITION": 0}, "indices": 1)",
                                                    R"("mesh": 0, "translation": [10, 20, 30], "scale": [2, 3, 4],
                                                       "rotation": [0, 0, 0.70710678, 0.70710678])"));
  ASSERT_TRUE(result.scene);
  expect_point(result.scene->shapes[0].object_to_world.point(Vec3f{2, 0, 0}), 10, 24, 30);
  expect_point(result.scene->shapes[0].object_to_world.point(Vec3f{0, 3, 1}), 1, 20, 34);
}

TEST(GltfNode, has_its_matrix_by_columns_and_that_of_its_parents_before_it) {
  const std::string json =
      triangle_json(R"("attributes": {"POSITION": 0}, "indices": 1)",
                    R"("children": [1], "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 7,8,9,1]}, {"mesh": 0,
                                            "translation": [1, 0, 0])");
  const ReadResult result = read_text(json);
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  expect_point(result.scene->shapes[0].object_to_world.point(Vec3f{0, 0, 0}), 7, 9, 9);
}

// Where a camera in the world looks: from camera space, x to the right, y up, z into the picture.
TEST(GltfCamera, looks_along_its_own_minus_z_with_x_to_the_right) {
  const ReadResult result = read_text(triangle_json(
      R"("attributes": {"POSITION": 0}, "indices": 1)",
      R"("mesh": 0, "children": [1]}, {"camera": 0, "translation": [0, 0, 5])",
      R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "aspectRatio": 2, "znear": 0.1}}])"));
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  const SceneDesc& scene = *result.scene;
  expect_point(scene.world_to_camera.point(Vec3f{1, 2, 2}), 1, 2, 3);
  EXPECT_NEAR(scene.camera.fov, 180 / std::numbers::pi, 1e-4);
  EXPECT_EQ(scene.camera.fov_axis, FovAxis::y);
  EXPECT_EQ(scene.film.width, 1280);
  EXPECT_EQ(scene.film.height, 640);
}

TEST(GltfCamera, may_be_orthographic_with_half_its_height_in_the_screen_window) {
  const ReadResult result =
      read_text(triangle_json(R"("attributes": {"POSITION": 0}, "indices": 1)", R"("mesh": 0, "camera": 0)",
                              R"(, "cameras": [{"type": "orthographic", "orthographic": {"xmag": 6, "ymag": 3,
                                    "znear": 0.1, "zfar": 9}}])"));
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  EXPECT_EQ(result.scene->camera.kind, CameraKind::orthographic);
  // The upper edge of the picture is y = 3, its right one x = 6.
  expect_point(result.scene->world_to_camera.point(Vec3f{6, 3, -4}), 2, 1, 4);
  EXPECT_EQ(result.scene->film.height, 640);
}

TEST(GltfCamera, is_chosen_by_name_or_number) {
  const std::string json =
      triangle_json(R"("attributes": {"POSITION": 0}, "indices": 1)",
                    R"("mesh": 0, "children": [1, 2]}, {"camera": 1, "name": "far"}, {"camera": 0)",
                    R"(, "cameras": [{"type": "perspective", "name": "near", "perspective": {"yfov": 1}},
                       {"type": "perspective", "perspective": {"yfov": 0.5}}])");
  const auto fov = [&](const std::optional<std::string>& choice) {
    ReadOptions options;
    options.camera = choice;
    const ReadResult result = read_text(json, options);
    EXPECT_TRUE(result.scene) << render(result.diagnostics);
    return result.scene ? result.scene->camera.fov * std::numbers::pi_v<float> / 180 : 0;
  };
  EXPECT_FLOAT_EQ(fov(std::nullopt), 0.5f);  // the first of the scene
  EXPECT_FLOAT_EQ(fov("far"), 0.5f);
  EXPECT_FLOAT_EQ(fov("near"), 1);
  EXPECT_FLOAT_EQ(fov("0"), 1);
  ReadOptions options;
  options.camera = "neer";
  const ReadResult wrong = read_text(json, options);
  EXPECT_FALSE(wrong.scene);
  EXPECT_NE(render(wrong.diagnostics).find("did you mean 'near'"), std::string::npos) << render(wrong.diagnostics);
}

TEST(GltfScene, without_camera_and_light_gets_both_and_says_so) {
  const ReadResult result = read_text(triangle_json());
  ASSERT_TRUE(result.scene);
  ASSERT_EQ(result.scene->lights.size(), 1u);
  EXPECT_EQ(name_of(result.scene->lights[0].model), "infinite");
  const std::string text = render(result.diagnostics);
  EXPECT_NE(text.find("note: the scene has no camera"), std::string::npos) << text;
  EXPECT_NE(text.find("note: the scene has no light"), std::string::npos) << text;
  // The stand-in sees all corners, in front of it and within its field of view.
  for (const Vec3f& p : {Vec3f{0, 0, 0}, Vec3f{2, 0, 0}, Vec3f{0, 3, 0}}) {
    const Vec3f c = result.scene->world_to_camera.point(p);
    EXPECT_GT(c.z, 0);
    EXPECT_LT(std::hypot(c.x, c.y) / c.z, std::tan(20 * std::numbers::pi / 180));
  }
  // It has x of the world to the right, and y up.
  const Transform& t = result.scene->world_to_camera;
  EXPECT_GT(t.direction(Vec3f{1, 0, 0}).x, 0);
  EXPECT_GT(t.direction(Vec3f{0, 1, 0}).y, 0);
}

TEST(GltfLight, has_its_intensity_color_and_cone) {
  const ReadResult result = read_text(triangle_json(
      R"("attributes": {"POSITION": 0}, "indices": 1)",
      R"("mesh": 0, "children": [1, 2]}, {"translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}},
         {"rotation": [-0.70710678, 0, 0, 0.70710678], "extensions": {"KHR_lights_punctual": {"light": 1}})",
      R"(, "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "spot", "intensity": 8, "color": [1, 0.5, 0.25], "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.3}},
            {"type": "directional", "intensity": 3}]}})"));
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  ASSERT_EQ(result.scene->lights.size(), 2u);
  const LightDesc &spot = result.scene->lights[0], &sun = result.scene->lights[1];
  const auto& cone = std::get<SpotLightDesc>(spot.model);
  expect_point(spot.light_to_world.point(cone.from), 1, 2, 3);
  expect_point(spot.light_to_world.direction(cone.to), 0, 0, -1);
  const auto emission = std::get<RgbValue>(cone.intensity).rgb;
  EXPECT_EQ(emission[0], 8);
  EXPECT_EQ(emission[2], 2);
  const float degrees = 180 / std::numbers::pi_v<float>;
  EXPECT_FLOAT_EQ(cone.cone_angle, 0.3f * degrees);
  EXPECT_FLOAT_EQ(cone.cone_delta_angle, 0.2f * degrees);
  EXPECT_EQ(cone.falloff, SpotFalloff::squared);
  // Turned a quarter about x, -z becomes -y.
  expect_point(sun.light_to_world.direction(std::get<DistantLightDesc>(sun.model).to), 0, -1, 0);
}

TEST(GltfMaterial, without_a_specular_part_is_lamberts) {
  const ReadResult result = read_text(triangle_json(
      R"("attributes": {"POSITION": 0}, "indices": 1, "material": 0)", R"("mesh": 0)",
      R"(, "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0},
            "emissiveFactor": [0.5, 1, 0], "doubleSided": true, "extensions": {"KHR_materials_specular":
            {"specularFactor": 0}, "KHR_materials_emissive_strength": {"emissiveStrength": 4}}}])"));
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  const ShapeDesc& shape = result.scene->shapes.at(0);
  const MaterialModel stated = DiffuseDesc{RgbValue{Rgb{{0.5f, 0.25f, 0.125f}}}};
  EXPECT_TRUE(result.scene->materials[std::size_t(shape.material)].model == stated);
  ASSERT_TRUE(shape.area_light);
  EXPECT_EQ(std::get<RgbValue>(shape.area_light->radiance).rgb[1], 1);
  EXPECT_EQ(shape.area_light->scale, 4);
  EXPECT_TRUE(shape.area_light->two_sided);
}

TEST(GltfMaterial, has_gltfs_defaults_where_there_is_none) {
  const ReadResult result = read_text(triangle_json());
  ASSERT_TRUE(result.scene);
  const MaterialDesc& material = result.scene->materials[std::size_t(result.scene->shapes.at(0).material)];
  const RgbValue white{gray_rgb(1.0f)};
  const MaterialModel stated = MetallicRoughnessDesc{white, 1.0f, 1.0f, 1.0f, white, 1.5f};
  EXPECT_TRUE(material.model == stated);
}

TEST(GltfMaterial, cuts_out_what_is_below_the_threshold_of_a_mask) {
  const auto alpha = [](const std::string& mode, double factor) {
    const ReadResult result = read_text(triangle_json(
        R"("attributes": {"POSITION": 0}, "indices": 1, "material": 0)", R"("mesh": 0)",
        R"(, "materials": [{"alphaMode": ")" + mode + R"(", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, )" +
            std::to_string(factor) + "]}}]"));
    EXPECT_TRUE(result.scene) << render(result.diagnostics);
    const std::optional<NumberInput>& stated = result.scene->shapes.at(0).alpha;
    return stated ? std::get<float>(stated->value) : -1;
  };
  EXPECT_EQ(alpha("OPAQUE", 0.25), -1);  // not stated
  EXPECT_EQ(alpha("MASK", 0.25), 0);
  EXPECT_EQ(alpha("MASK", 0.75), 1);
  EXPECT_EQ(alpha("BLEND", 0.25), 0.25f);
}

TEST(GltfScene, keeps_a_large_mesh_once_that_is_shown_twice) {
  // A strip of 400 vertices.
  Bytes bytes;
  for (int i = 0; i < 400; ++i) bytes.put<float>({float(i / 2), float(i % 2), 0});
  const std::string json =
      R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 5, 0]}, {"mesh": 0,
          "scale": [-1, 1, 1]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}]}],
          "bufferViews": [{"buffer": 0, "byteLength": 4800}],
          "accessors": [{"bufferView": 0, "componentType": 5126, "count": 400, "type": "VEC3"}], )" +
      buffers_of(bytes) + "}";
  const ReadResult result = read_text(json);
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  EXPECT_TRUE(result.scene->shapes.empty());
  ASSERT_EQ(result.scene->instances.size(), 3u);
  EXPECT_EQ(result.scene->instances[0].object, result.scene->instances[1].object);
  expect_point(result.scene->instances[1].object_to_world.point(Vec3f{0, 0, 0}), 0, 5, 0);
}

TEST(GltfScene, may_come_as_a_binary_file) {
  TemporaryFolder folder;
  const std::string json = triangle_json(R"("attributes": {"POSITION": 0}, "indices": 1)", R"("mesh": 0)", "",
                                         R"("buffers": [{"byteLength": 44}])");
  const std::string path = folder.write("scene.glb", binary_file(json, triangle_bytes().text()));
  const ReadResult result = read_scene(path);
  EXPECT_EQ(only_mesh(result).positions[2].y, 3);
}

TEST(GltfScene, names_files_with_escapes) {
  TemporaryFolder folder;
  folder.write("a b.bin", triangle_bytes().text());
  const std::string json = triangle_json(R"("attributes": {"POSITION": 0}, "indices": 1)", R"("mesh": 0)", "",
                                         R"("buffers": [{"byteLength": 44, "uri": "a%20b.bin"}])");
  const ReadResult result = read_scene(folder.write("scene.gltf", json));
  EXPECT_EQ(only_mesh(result).positions[2].y, 3);
}

// The folder of development scenes; empty where there is none.
std::filesystem::path scene_folder() {
  if (const char* folder = std::getenv("MONTELUX_SCENES")) return folder;
  for (const char* beside : {"/../shared/scenes", "/../../shared/scenes"})
    if (std::filesystem::exists(MONTELUX_SOURCE_DIR + std::string(beside)))
      return MONTELUX_SOURCE_DIR + std::string(beside);
  return {};
}

TEST(GltfScene, of_other_makers_are_read_without_an_error) {
  if (scene_folder().empty()) GTEST_SKIP() << "no folder of scenes: set MONTELUX_SCENES";
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scene_folder())) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".gltf" && ending != ".glb") continue;
    ReadResult result = read_scene(entry.path().string());
    ASSERT_TRUE(result.scene) << render(result.diagnostics);
    // Images are decoded, too, those inside of the file among them.
    EXPECT_TRUE(prepare(*result.scene, {}, result.diagnostics)) << render(result.diagnostics);
    ++count;
  }
  EXPECT_GE(count, 11);
}

TEST(GltfScene, that_is_bundled_is_read_without_a_word) {
  const ReadResult result = read_scene(MONTELUX_SOURCE_DIR "/scenes/clockwork/clockwork.gltf");
  ASSERT_TRUE(result.scene);
  EXPECT_TRUE(result.diagnostics.all().empty()) << render(result.diagnostics);
}

TEST(SceneFile, is_read_by_its_ending) {
  TemporaryFolder folder;
  EXPECT_TRUE(read_scene(folder.write("a.pbrt", "WorldBegin\n")).scene);
  EXPECT_TRUE(read_scene(folder.write("b.GLTF", triangle_json())).scene);
  const ReadResult unknown = read_scene(folder.write("c.gtlf", triangle_json()));
  EXPECT_FALSE(unknown.scene);
  const std::string text = render(unknown.diagnostics);
  EXPECT_NE(text.find("valid: .pbrt, .pbrt.gz, .gltf, .glb"), std::string::npos) << text;
  EXPECT_NE(text.find("did you mean '.gltf'"), std::string::npos) << text;
  EXPECT_NE(render(read_scene("noending").diagnostics).find("must end in"), std::string::npos);
}

}  // namespace
}  // namespace montelux
