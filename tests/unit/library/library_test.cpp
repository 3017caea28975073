// Scenes in code: the same pictures as from files, and errors as values.
#include <gtest/gtest.h>
#include <montelux/montelux.h>

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "temporary_folder.h"

namespace montelux::test {

namespace {

namespace mx = montelux::api;

constexpr std::uint32_t none = 1u << 20;

// A room's corner with a texture, glass, an object that stands twice, a lamp and a sky.
mx::Scene corner() {
  mx::Scene scene;
  scene.set_film(16, 12);
  scene.set_camera({"perspective", {{"fov", 50}}}, mx::look_at({0, 1.5f, -5}, {0, 1, 0}, {0, 1, 0}));
  scene.set_filter({"box", {}});
  scene.set_sampler({"halton", {{"pixelsamples", 8}, {"seed", 3}}});
  const mx::TextureId checks = scene.add_texture(
      mx::TextureKind::color,
      {"checkerboard",
       {{"tex1", mx::Rgb{0.8f, 0.4f, 0.1f}}, {"tex2", mx::Rgb{0.1f, 0.2f, 0.3f}}, {"uscale", 4}, {"vscale", 4.0}}});
  const mx::MaterialId floor = scene.add_material({"diffuse", {{"reflectance", checks}}});
  const mx::MaterialId glass = scene.add_material({"dielectric", {{"eta", 1.5}, {"roughness", 0.1}}});
  const mx::MaterialId copper = scene.add_material({"conductor", {{"eta", mx::NamedSpectrum{"metal-Cu-eta"}}}});
  const mx::MaterialId mixed =
      scene.add_material({"mix", {{"materials", std::vector{floor, copper}}, {"amount", 0.25}}});

  mx::Mesh square;
  square.positions = {{-3, 0, -3}, {3, 0, -3}, {3, 0, 3}, {-3, 0, 3}};
  square.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.triangles = {0, 2, 1, 0, 3, 2};
  scene.add_mesh(square, {.material = floor});
  scene.add_shape({"sphere", {{"radius", 0.5}}}, {.material = glass, .object_to_world = mx::translate(0, 0.5, 0)});
  scene.add_shape({"disk", {}}, {.area_light = mx::Model{"diffuse", {{"L", mx::Blackbody{4000}}, {"scale", 5}}},
                                 .object_to_world = mx::translate(0, 3, 0) * mx::rotate(90, 1, 0, 0)});
  const mx::ObjectId ball = scene.add_object();
  scene.add_shape({"sphere", {{"radius", 0.25}}}, {.material = mixed, .object = ball});
  scene.add_instance(ball, mx::translate(-1, 0.25, 0));
  scene.add_instance(ball, mx::translate(1, 0.5, 0) * mx::scale(1, 2, 1));
  scene.add_light({"infinite", {{"L", mx::Rgb{0.1f, 0.2f, 0.3f}}}});
  return scene;
}

// The same, as pbrt has it.
constexpr const char* corner_text = R"(
LookAt 0 1.5 -5  0 1 0  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 16 "integer yresolution" 12
PixelFilter "box"
Sampler "halton" "integer pixelsamples" 8 "integer seed" 3
WorldBegin
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [ 0.8 0.4 0.1 ] "rgb tex2" [ 0.1 0.2 0.3 ]
  "float uscale" 4 "float vscale" 4
MakeNamedMaterial "floor" "string type" "diffuse" "texture reflectance" "checks"
MakeNamedMaterial "glass" "string type" "dielectric" "float eta" 1.5 "float roughness" 0.1
MakeNamedMaterial "copper" "string type" "conductor" "spectrum eta" "metal-Cu-eta"
MakeNamedMaterial "mixed" "string type" "mix" "string materials" [ "floor" "copper" ] "float amount" 0.25
AttributeBegin
  NamedMaterial "floor"
  Shape "trianglemesh" "point3 P" [ -3 0 -3  3 0 -3  3 0 3  -3 0 3 ] "point2 uv" [ 0 0 1 0 1 1 0 1 ]
    "integer indices" [ 0 2 1 0 3 2 ]
AttributeEnd
AttributeBegin
  NamedMaterial "glass"
  Translate 0 0.5 0
  Shape "sphere" "float radius" 0.5
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "blackbody L" 4000 "float scale" 5
  Translate 0 3 0
  Rotate 90 1 0 0
  Shape "disk"
AttributeEnd
ObjectBegin "ball"
  NamedMaterial "mixed"
  Shape "sphere" "float radius" 0.25
ObjectEnd
AttributeBegin
  Translate -1 0.25 0
  ObjectInstance "ball"
AttributeEnd
AttributeBegin
  Translate 1 0.5 0
  Scale 1 2 1
  ObjectInstance "ball"
AttributeEnd
LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
)";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(SceneInCode, gives_the_bits_of_the_same_scene_in_a_file) {
  TemporaryFolder folder;
  folder.write("corner.pbrt", corner_text);
  const mx::PreparedScene code = mx::prepare(corner()).value();
  const mx::PreparedScene file = mx::load(folder.path() + "/corner.pbrt").value();
  const mx::Picture a = code.render({.threads = 2}).value(), b = file.render({.threads = 1}).value();
  ASSERT_EQ(a.width(), 16);
  ASSERT_EQ(a.height(), 12);
  EXPECT_EQ(a.rgb(), b.rgb());
  EXPECT_GT(a.mean().mean[0], 0.01);
  // It is not the same for any scene.
  mx::Scene other = corner();
  other.add_light({"point", {{"from", mx::Vec3{0, 2, -2}}}});
  EXPECT_NE(mx::prepare(other).value().render().value().rgb(), b.rgb());
}

// A cloud in a lit fog.
mx::Scene cloud() {
  mx::Scene scene;
  scene.set_film(8, 8);
  scene.set_camera({"perspective", {{"fov", 40}}}, mx::look_at({0, 0, -5}, {0, 0, 0}, {0, 1, 0}));
  scene.set_sampler({"independent", {{"pixelsamples", 8}}});
  const mx::MediumId milk = scene.add_medium(
      {"homogeneous", {{"sigma_a", mx::Rgb{0, 0.1f, 0.2f}}, {"sigma_s", mx::Rgb{0.5f, 2, 6}}, {"g", 0.6}}});
  const mx::MediumId fog = scene.add_medium({"homogeneous", {{"sigma_s", mx::Rgb{0.05f, 0.05f, 0.1f}}}});
  scene.set_camera_medium(fog);
  const mx::MaterialId interface = scene.add_material({"interface", {}});
  scene.add_shape({"sphere", {}}, {.material = interface, .media = {.inside = milk, .outside = fog}});
  scene.add_light({"point", {{"from", mx::Vec3{0, 2, -2}}, {"I", mx::Rgb{9, 8, 7}}}});
  return scene;
}
constexpr const char* cloud_text = R"(
MakeNamedMedium "milk" "string type" "homogeneous" "rgb sigma_a" [ 0 .1 .2 ] "rgb sigma_s" [ .5 2 6 ] "float g" .6
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ .05 .05 .1 ]
MediumInterface "" "fog"
LookAt 0 0 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent" "integer pixelsamples" 8
WorldBegin
Material "interface"
MediumInterface "milk" "fog"
Shape "sphere"
LightSource "point" "point3 from" [ 0 2 -2 ] "rgb I" [ 9 8 7 ]
)";

TEST(SceneInCode, has_media_as_a_file_has_them) {
  TemporaryFolder folder;
  folder.write("cloud.pbrt", cloud_text);
  const mx::Picture a = mx::prepare(cloud()).value().render().value();
  const mx::Picture b = mx::load(folder.path() + "/cloud.pbrt").value().render().value();
  EXPECT_EQ(a.rgb(), b.rgb());
  EXPECT_GT(a.mean().mean[0], 0.001);
  mx::Scene clear = cloud();
  clear.set_camera_medium({});
  EXPECT_NE(mx::prepare(clear).value().render().value().rgb(), b.rgb());
  mx::Scene wrong = cloud();
  wrong.set_camera_medium(mx::MediumId{9});
  wrong.add_medium({"homogenous", {}});
  wrong.add_shape({"sphere", {}}, {.media = {.inside = mx::MediumId{7}}});
  const mx::Result<mx::PreparedScene> prepared = mx::prepare(wrong);
  ASSERT_FALSE(prepared);
  const std::string all = prepared.error().what();
  for (const char* part : {"camera: error: the medium is none of this scene", "did you mean 'homogeneous'",
                           "shape 1: error: the medium is none of this scene"})
    EXPECT_TRUE(contains(all, part)) << part << "\n" << all;
}

TEST(SceneInCode, is_copied_with_all_that_it_holds) {
  const mx::Scene scene = corner();
  mx::Scene copy = scene;
  copy.set_camera({"orthographic", {}});
  const std::vector<float> picture = mx::prepare(scene).value().render().value().rgb();
  EXPECT_EQ(picture, mx::prepare(corner()).value().render().value().rgb());
  EXPECT_NE(picture, mx::prepare(copy).value().render().value().rgb());
}

TEST(SceneInCode, reports_all_that_is_wrong_at_once) {
  mx::Scene scene;
  scene.set_film(0, 10);
  scene.set_camera({"perspective", {{"fov", 200}}}, mx::look_at({0, 0, 0}, {0, 0, 0}, {0, 1, 0}));
  scene.add_material({"diffuse", {{"reflectence", mx::Rgb{1, 1, 1}}}});
  scene.add_material({"conducter", {}});
  scene.add_material({"conductor", {{"roughness", "rough"}, {"eta", mx::NamedSpectrum{"metal-Cuu-eta"}}}});
  scene.add_material({"diffuse", {{"reflectance", mx::TextureId{7}}}});
  scene.add_material({"hair", {}});
  const mx::TextureId number = scene.add_texture(mx::TextureKind::number, {"constant", {{"value", 1}}});
  scene.add_material({"diffuse", {{"reflectance", number}}});
  scene.add_material({"dielectric", {{"eta", std::nan("")}}});
  scene.add_light({"infinite", {{"L", mx::Rgb{1, -1, 1}}}});
  scene.add_light({"infinite", {{"filename", "no such file.exr"}}});
  scene.add_mesh({.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {0, 1, 3}});
  scene.add_mesh({.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {{0, 0, 1}}, .triangles = {0, 1, 2}});
  scene.add_mesh(
      {.positions = {{0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<float>::infinity(), 0}}, .triangles = {0, 1, 2}});
  scene.add_shape({"sphere", {}}, {.material = mx::MaterialId{none}});
  scene.add_shape({"sphere", {}}, {.object_to_world = mx::scale(1, 0, 1)});
  scene.add_instance(mx::ObjectId{3}, {});
  const mx::Result<mx::PreparedScene> prepared = mx::prepare(scene);
  ASSERT_FALSE(prepared);
  const std::string all = prepared.error().what();
  for (const char* part : {"film: error: 'xresolution' must be at least 1",
                           "camera: error: 'fov' must be at most 179.99",
                           "camera: error: the transform is not an affine map",
                           "material 0: error: material 'diffuse' has no parameter",
                           "did you mean 'reflectance'",
                           "material 1: error: there is no material 'conducter'",
                           "'roughness' of material 'conductor' must be double or TextureId, not a string",
                           "did you mean 'metal-Cu-eta'",
                           "material 3: error: 'reflectance' takes a texture of the same scene",
                           "material 'hair' is not supported yet",
                           "texture 0 is one of numbers",
                           "material 6: error: 'eta' takes finite numbers",
                           "light 0: error: 'L' must not be negative",
                           "there is no file 'no such file.exr'",
                           "index 3 has no vertex",
                           "1 normals",
                           "not finite",
                           "shape 3: error: the material is none of this scene",
                           "shape 4: error: the transform is not an affine map",
                           "instance 0: error: the object is none of this scene"})
    EXPECT_TRUE(contains(all, part)) << part << "\n" << all;
  EXPECT_GE(prepared.error().messages().size(), 19u);
}

TEST(SceneInCode, warns_of_parameters_without_effect) {
  mx::Scene scene;
  scene.set_film(4, 4, {{"sensor", "cie1931"}});
  scene.add_material({"conductor", {{"roughness", 0.1}, {"uroughness", 0.2}, {"vroughness", 0.3}}});
  scene.add_shape({"sphere", {}});
  const mx::PreparedScene prepared = mx::prepare(scene).value();
  ASSERT_EQ(prepared.messages().size(), 2u);
  EXPECT_EQ(prepared.messages()[0].severity, mx::Severity::warning);
  EXPECT_EQ(to_text(prepared.messages()[0]), "film: warning: 'sensor' of film 'rgb' has no effect yet");
  EXPECT_EQ(to_text(prepared.messages()[1]),
            "material 0: warning: 'roughness' of material 'conductor' has no effect here");
}

TEST(SceneInCode, has_no_error_bar_without_light) {
  mx::Scene scene;
  scene.set_film(4, 4);
  scene.add_shape({"sphere", {}});
  const mx::Picture picture = mx::prepare(scene).value().render().value();
  EXPECT_TRUE(std::isinf(picture.pixel(1, 1).standard_error[0]));
  EXPECT_FALSE(picture.pixel(1, 1).interval(0));
  EXPECT_FALSE(picture.mean().interval(0));
}

TEST(Render, returns_errors_of_settings_and_of_the_observer) {
  const mx::PreparedScene scene = mx::prepare(corner()).value();
  EXPECT_TRUE(contains(scene.render({.integrator = "pth"}).error().what(), "did you mean \"path\""));
  EXPECT_TRUE(contains(scene.render({.samples = 0}).error().what(), "number of samples"));
  EXPECT_FALSE(scene.render({.samples = 1, .seconds = 1}));
  const auto thrown = scene.render({.progress = [](const mx::Progress&) -> bool { throw std::runtime_error("mine"); }});
  ASSERT_FALSE(thrown);
  EXPECT_STREQ(thrown.error().what(), "mine");
  EXPECT_THROW((void)scene.render({.sampler = "none"}).value(), mx::Error);
}

TEST(Render, ends_early_where_the_observer_requests_it) {
  const mx::PreparedScene scene = mx::prepare(corner()).value();
  const auto has_no_sample = [](const mx::Progress& p) { return p.samples == 0; };
  const mx::Picture picture = scene.render({.samples = 1 << 22, .progress = has_no_sample}).value();
  EXPECT_TRUE(picture.interrupted());
  EXPECT_GT(picture.mean().samples, 0);
}

TEST(Picture, has_intervals_of_its_pixels_by_students_t) {
  const mx::Picture picture = mx::prepare(corner()).value().render({.samples = 64}).value();
  const mx::Estimate pixel = picture.pixel(8, 9);
  ASSERT_GE(pixel.passes, 2);
  EXPECT_EQ(pixel.samples, 64);
  const mx::Interval interval = pixel.interval(1).value();
  EXPECT_NEAR((interval.low + interval.high) / 2, pixel.mean[1], 1e-9);
  // 97.5 % quantiles of Student's t, from tables.
  const std::map<int, double> quantiles{{4, 3.182446}, {8, 2.364624}, {16, 2.131450}, {32, 2.039513}};
  ASSERT_TRUE(quantiles.contains(pixel.passes)) << pixel.passes;
  EXPECT_NEAR((interval.high - interval.low) / 2 / pixel.standard_error[1], quantiles.at(pixel.passes), 1e-5);
  EXPECT_FALSE(pixel.interval(3));
  EXPECT_FALSE(pixel.interval(0, 1));
}

TEST(Picture, is_written_and_says_where_it_cannot_be) {
  TemporaryFolder folder;
  const mx::Picture picture = mx::prepare(corner()).value().render().value();
  for (const char* name : {"a.exr", "a.pfm", "a.png"}) {
    const mx::Status written = picture.write(folder.path() + "/" + name);
    EXPECT_TRUE(written) << written.error().what();
    EXPECT_TRUE(std::filesystem::exists(folder.path() + "/" + name));
  }
  EXPECT_FALSE(picture.write(folder.path() + "/no/folder/a.exr"));
  EXPECT_FALSE(picture.write(folder.path() + "/a.docx"));
}

}  // namespace

}  // namespace montelux::test
