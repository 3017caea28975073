// What directives mean: transforms, scopes, names, meshes.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <filesystem>

#include "io/pbrt.h"
#include "io/report.h"
#include "temporary_folder.h"

namespace montelux {
namespace {

using test::TemporaryFolder;

SceneDesc read(const std::string& text, const std::string& folder = ".") {
  ReadResult result = read_pbrt_text(text, folder);
  EXPECT_TRUE(result.scene) << render(result.diagnostics, {false, false});
  return result.scene.value_or(SceneDesc{});
}
// The transform that a sphere gets from directives.
Transform transform_of(const std::string& directives) {
  SceneDesc scene = read("WorldBegin\n" + directives + " Shape \"sphere\"");
  return scene.shapes.empty() ? Transform() : scene.shapes.front().object_to_world;
}
void expect_point(const Transform& transform, Vec3f p, Vec3f expected) {
  Vec3f q = transform.point(p);
  EXPECT_NEAR(q.x, expected.x, 1e-5f);
  EXPECT_NEAR(q.y, expected.y, 1e-5f);
  EXPECT_NEAR(q.z, expected.z, 1e-5f);
}

TEST(Transforms, apply_the_last_directive_first) {
  expect_point(transform_of("Translate 1 2 3 Scale 2 2 2"), {1, 1, 1}, {3, 4, 5});
  expect_point(transform_of("Scale 2 2 2 Translate 1 2 3"), {1, 1, 1}, {4, 6, 8});
  expect_point(transform_of("Scale 2 2 2 Identity"), {1, 1, 1}, {1, 1, 1});
}
TEST(Transforms, rotate_by_the_right_hand_rule) {
  expect_point(transform_of("Rotate 90 0 0 1"), {1, 0, 0}, {0, 1, 0});
  expect_point(transform_of("Rotate 90 1 0 0"), {0, 1, 0}, {0, 0, 1});
}
TEST(Transforms, read_matrices_column_after_column) {
  expect_point(transform_of("Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1 ]"), {1, 1, 1}, {6, 7, 8});
  expect_point(transform_of("Scale 2 2 2 ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1 ]"), {0, 0, 0},
               {10, 12, 14});
}
TEST(Transforms, return_to_named_coordinates) {
  expect_point(transform_of("Translate 1 0 0 CoordinateSystem \"here\" Scale 3 3 3 CoordSysTransform \"here\""),
               {0, 0, 0}, {1, 0, 0});
  SceneDesc scene =
      read("LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" WorldBegin CoordSysTransform \"camera\" Shape \"sphere\"");
  expect_point(scene.shapes.at(0).object_to_world, {0, 0, 0}, {0, 0, 5});
  expect_point(scene.world_to_camera, {0, 0, 0}, {0, 0, 5});
}
TEST(Transforms, stay_inside_of_their_blocks) {
  expect_point(transform_of("AttributeBegin Translate 1 0 0 AttributeEnd TransformBegin Scale 9 9 9 TransformEnd"),
               {1, 1, 1}, {1, 1, 1});
}
TEST(Transforms, that_move_alike_do_not_move) {
  expect_point(transform_of("ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 1 0 0"),
               {0, 0, 0}, {1, 0, 0});
}

TEST(Attributes, end_with_their_block) {
  SceneDesc scene = read(
      "WorldBegin AttributeBegin ReverseOrientation Material \"dielectric\" AreaLightSource \"diffuse\" \"rgb L\" [ 1 "
      "2 3 ]\n"
      "Shape \"sphere\" AttributeEnd Shape \"sphere\"");
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_TRUE(scene.shapes[0].reverse_orientation);
  EXPECT_TRUE(scene.shapes[0].area_light);
  EXPECT_TRUE(std::holds_alternative<DielectricDesc>(
      scene.materials.at(static_cast<std::size_t>(scene.shapes[0].material)).model));
  EXPECT_FALSE(scene.shapes[1].reverse_orientation);
  EXPECT_FALSE(scene.shapes[1].area_light);
  EXPECT_TRUE(std::holds_alternative<DiffuseDesc>(
      scene.materials.at(static_cast<std::size_t>(scene.shapes[1].material)).model));
}
TEST(Attributes, give_defaults_that_statements_override) {
  SceneDesc scene =
      read("WorldBegin Attribute \"shape\" \"float radius\" 2 Shape \"sphere\" Shape \"sphere\" \"float radius\" 3");
  EXPECT_EQ(std::get<SphereForm>(scene.shapes.at(0).form).radius, 2);
  EXPECT_EQ(std::get<SphereForm>(scene.shapes.at(1).form).radius, 3);
}
TEST(Names, of_materials_may_be_used_before_they_are_defined) {
  SceneDesc scene =
      read("WorldBegin NamedMaterial \"g\" Shape \"sphere\" MakeNamedMaterial \"g\" \"string type\" \"dielectric\"");
  EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(scene.shapes.at(0).material)).name, "g");
}
const SpectrumValue& intensity_of(const SceneDesc& scene, std::size_t light) {
  return std::get<PointLightDesc>(scene.lights.at(light).model).intensity;
}

TEST(Values, keep_the_colour_space_in_force) {
  SceneDesc scene = read("WorldBegin ColorSpace \"rec2020\" LightSource \"point\" \"rgb I\" [ 1 2 3 ]");
  const auto& rgb = std::get<RgbValue>(intensity_of(scene, 0));
  EXPECT_EQ(rgb.color_space, "rec2020");
  EXPECT_EQ(rgb.rgb.c[2], 3);
}
TEST(Values, may_be_spectra_of_every_notation) {
  SceneDesc scene = read(
      "WorldBegin LightSource \"point\" \"blackbody I\" 6500 LightSource \"point\" \"spectrum I\" [ 400 1 700 2 ]\n"
      "LightSource \"point\" \"spectrum I\" \"stdillum-D65\"");
  EXPECT_EQ(std::get<Blackbody>(intensity_of(scene, 0)).kelvin, 6500);
  EXPECT_EQ(std::get<SampledValue>(intensity_of(scene, 1)).values.at(1), 2);
  EXPECT_EQ(std::get<NamedSpectrum>(intensity_of(scene, 2)).name, "stdillum-D65");
}
TEST(Values, of_spectra_may_come_from_a_file) {
  TemporaryFolder folder;
  folder.write("red.spd", "# nm value\n400 0\n600 1\n700 1\n");
  SceneDesc scene = read("WorldBegin LightSource \"point\" \"spectrum I\" \"red.spd\"", folder.path());
  EXPECT_EQ(std::get<SampledValue>(intensity_of(scene, 0)).wavelengths.size(), 3u);
}
TEST(Meshes, take_their_arrays_from_the_parameters) {
  SceneDesc scene = read(
      "WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"normal N\" [ 0 0 1 0 0 1 0 0 1 ]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]");
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(mesh_of(scene.shapes[0])->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh_of(scene.shapes[0])->normals.size(), 3u);
  EXPECT_EQ(mesh_of(scene.shapes[1])->quads, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}
TEST(Objects, hold_their_shapes_until_they_are_placed) {
  SceneDesc scene = read(
      "WorldBegin ObjectBegin \"tree\" Translate 0 1 0 Shape \"sphere\" ObjectEnd\n"
      "AttributeBegin Translate 5 0 0 ObjectInstance \"tree\" AttributeEnd");
  EXPECT_TRUE(scene.shapes.empty());
  ASSERT_EQ(scene.objects.size(), 1u);
  expect_point(scene.objects[0].shapes.at(0).object_to_world, {0, 0, 0}, {0, 1, 0});
  expect_point(scene.instances.at(0).object_to_world, {0, 0, 0}, {5, 0, 0});
}

TEST(Includes, take_part_in_the_state_and_imports_do_not) {
  TemporaryFolder folder;
  folder.write("moved.pbrt", "Translate 1 0 0 Shape \"sphere\"\n");
  std::string main_file = folder.write(
      "main.pbrt", "WorldBegin Import \"moved.pbrt\" Shape \"sphere\" Include \"moved.pbrt\" Shape \"sphere\"");
  ReadResult result = read_pbrt(main_file);
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  const auto& shapes = result.scene->shapes;
  ASSERT_EQ(shapes.size(), 4u);
  const std::array<float, 4> expected{1, 0, 1, 1};
  for (std::size_t i = 0; i < 4; ++i) expect_point(shapes[i].object_to_world, {0, 0, 0}, {expected[i], 0, 0});
}
TEST(Includes, of_themselves_are_errors_through_links_too) {
  TemporaryFolder folder;
  std::string a = folder.write("a.pbrt", "WorldBegin\nInclude \"link.pbrt\"\n");
  folder.write("b.pbrt", "Include \"a.pbrt\"\n");
  std::filesystem::create_symlink("b.pbrt", folder.path() + "/link.pbrt");
  ReadResult result = read_pbrt(a);
  EXPECT_FALSE(result.scene);
  ASSERT_EQ(result.diagnostics.errors(), 1) << render(result.diagnostics);
  const Diagnostic& d = result.diagnostics.all().front();
  EXPECT_NE(d.message.find("includes itself"), std::string::npos);
  EXPECT_NE(d.where.file->find("link.pbrt"), std::string::npos);
  EXPECT_EQ(d.where.line, 1);
}
TEST(Includes, that_double_without_end_are_cut_off) {
  TemporaryFolder folder;
  for (int i = 0; i < 40; ++i) {
    std::string next = std::string("Include \"f") + std::to_string(i + 1) + ".pbrt\"\n";
    folder.write(std::string("f") + std::to_string(i) + ".pbrt", (i == 0 ? "WorldBegin\n" : "") + next + next);
  }
  folder.write("f40.pbrt", "");
  EXPECT_FALSE(read_pbrt(folder.path() + "/f0.pbrt").scene);
}
TEST(CompressedFiles, read_as_if_they_were_not) {
  TemporaryFolder folder;
  std::string path = folder.path() + "/scene.pbrt.gz";
  std::string text = "WorldBegin Shape \"sphere\"\n";
  gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  ReadResult result = read_pbrt(path);
  ASSERT_TRUE(result.scene) << render(result.diagnostics);
  EXPECT_EQ(result.scene->shapes.size(), 1u);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 9);
  EXPECT_FALSE(read_pbrt(path).scene);
}
TEST(Files, that_are_none_are_errors) {
  EXPECT_FALSE(read_pbrt("/nonexistent/scene.pbrt").scene);
  EXPECT_FALSE(read_pbrt("/").scene);
  EXPECT_FALSE(read_pbrt("/dev/zero").scene);
}
TEST(Reports, show_the_line_and_a_caret) {
  TemporaryFolder folder;
  std::string path = folder.write("scene.pbrt", "WorldBegin\n  Shape \"spere\"\n");
  std::string text = render(read_pbrt(path).diagnostics);
  EXPECT_EQ(text.substr(0, text.find("    valid")).substr(0, path.size() + 6), path + ":2:9: ");
  EXPECT_NE(text.find("      Shape \"spere\"\n            ^\n"), std::string::npos) << text;
  EXPECT_NE(text.find("did you mean 'sphere'?"), std::string::npos) << text;
}

}  // namespace
}  // namespace montelux
