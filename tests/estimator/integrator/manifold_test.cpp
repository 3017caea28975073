// path:manifold against light, whose paths start at the lights: the same light where the camera sees the floor alone.
// Shapes, materials and lights of every kind that chains may meet.
#include <gtest/gtest.h>

#include <numbers>

#include "colour_means.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

// The camera is between the floor, a patch about (0, -1.8, 0), and what stands above it.
const std::string head =
    "Film \"rgb\" \"integer xresolution\" [ 8 ] \"integer yresolution\" [ 8 ]\nPixelFilter \"box\"\n"
    "LookAt 0 -1.78 0  0 -1.8 0  0 0 1\nCamera \"orthographic\" \"float screenwindow\" [ -0.2 0.3 -0.25 0.25 ]\n"
    "WorldBegin\n";
const std::string floor_patch =
    "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.3 0.15 ]\nShape \"trianglemesh\" \"integer indices\" [ 0 1 2  0 "
    "2 "
    "3 ]\n    \"point3 P\" [ -0.4 -1.8 -0.4  -0.4 -1.8 0.4  0.4 -1.8 0.4  0.4 -1.8 -0.4 ]\n";
const std::string point = "LightSource \"point\" \"rgb I\" [ 3 1 5 ] \"point3 from\" [ 0.4 3 0.2 ]\n";
const std::string beside = "LightSource \"point\" \"rgb I\" [ 3 1 5 ] \"point3 from\" [ -1.5 0 0.2 ]\n";
const std::string glass = "Material \"dielectric\" \"float eta\" [ 1.2 ]\n";
const std::string gold =
    "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" \"float roughness\" [ 0 "
    "]\n";

// A sphere of triangles with the normals of the sphere, which are not unit.
std::string tessellated_sphere(int rows, int columns) {
  std::ostringstream p, n, index;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double theta = std::numbers::pi * i / rows, phi = 2 * std::numbers::pi * j / columns;
      const double x = std::sin(theta) * std::cos(phi), y = std::cos(theta), z = std::sin(theta) * std::sin(phi);
      const double size = 1 + 0.5 * ((i + j) % 2);
      p << x << " " << y << " " << z << "  ", n << size * x << " " << size * y << " " << size * z << "  ";
      if (i == rows) continue;
      const int next = (j + 1) % columns, a = i * columns + j, b = i * columns + next;
      index << a << " " << a + columns << " " << b << "  " << b << " " << a + columns << " " << b + columns << "  ";
    }
  return "Shape \"trianglemesh\" \"integer indices\" [ " + index.str() + " ] \"point3 P\" [ " + p.str() +
         " ] \"normal N\" [ " + n.str() + " ]\n";
}

struct Case {
  const char* name;
  std::string world;
  int length = 2, samples = 64;
  double fault = 1.1;
};

std::vector<Case> cases() {
  const std::string ball = "Shape \"sphere\" \"float radius\" [ 1 ]\n";
  return {
      {"a sphere of triangles", point + glass + tessellated_sphere(32, 48)},
      {"a scaled instance",
       point + glass + "ObjectBegin \"ball\"\nRotate 30 0 0 1\nScale 1.2 0.8 1\n" + ball +
           "ObjectEnd\nTranslate 0.1 0 0\nRotate 20 1 0 0\nScale 1 1.1 0.9\nObjectInstance \"ball\"\n"},
      {"a ring of gold",
       "LightSource \"spot\" \"rgb I\" [ 3 1 5 ] \"point3 from\" [ 1.2 -0.8 0.1 ] \"point3 to\" [ -0.6 -1.6 0 ] "
       "\"float "
       "coneangle\" [ 40 ]\n" +
           gold +
           "Translate 0 -1.9 0\nRotate -90 1 0 0\nShape \"cylinder\" \"float radius\" [ 0.7 ] \"float zmin\" [ 0 ] "
           "\"float zmax\" [ 0.4 ]\n"},
      {"a pane and a mirror",
       "LightSource \"distant\" \"rgb L\" [ 3 1 5 ] \"point3 from\" [ -1 1.5 0 ] \"point3 to\" [ 0 0 0 ]\nMaterial "
       "\"thindielectric\" \"float eta\" [ 1.5 ]\nShape \"trianglemesh\" \"integer indices\" [ 0 1 2  0 2 3 ] \"point3 "
       "P\" "
       "[ -3 -1 -3  -3 -1 3  3 -1 3  3 -1 -3 ]\n" +
           gold +
           "Shape \"disk\" \"float radius\" [ 1 ] \"float height\" [ -0.8 ]\nTranslate 1 -1 0\nRotate 80 0 1 0\n"
           "Shape \"disk\" \"float radius\" [ 0.6 ]\n"},
      {"a bent mirror",
       beside + gold +
           "Translate 0.9 -1.2 0\nShape \"bilinearmesh\" \"point3 P\" [ 0 -0.5 -0.6  0.2 -0.5 0.6  0.3 0.7 -0.6  0 0.6 "
           "0.6 "
           "]\n",
       1},
      {"a mirror with normals",
       beside + gold +
           "Translate 0.9 -1.2 0\nShape \"bilinearmesh\" \"point3 P\" [ 0 -0.5 -0.6  0 -0.5 0.6  0.3 0.7 -0.6  0.3 0.6 "
           "0.6 "
           "] \"normal N\" [ -1 0.2 0.1  -1 0.1 -0.1  -2 0.6 0.1  -1 0.3 -0.1 ]\n",
       1},
      {"half a mirror",
       beside + "Texture \"half\" \"float\" \"constant\" \"float value\" [ 0.5 ]\n" + gold +
           "Translate 0.9 -1.2 0\nRotate 80 0 1 0\nShape \"disk\" \"float radius\" [ 0.7 ] \"texture alpha\" "
           "\"half\"\n",
       1},
      {"glass that is rough in part",
       point + glass +
           "MakeNamedMaterial \"clear\" \"string type\" \"dielectric\" \"float eta\" [ 1.2 ]\nMakeNamedMaterial "
           "\"white\" "
           "\"string type\" \"diffuse\" \"rgb reflectance\" [ 0.2 0.5 0.7 ]\nMakeNamedMaterial \"mixed\" \"string "
           "type\" "
           "\"mix\" \"string materials\" [ \"clear\" \"white\" ] \"float amount\" [ 0.2 ]\nNamedMaterial \"mixed\"\n" +
           ball},
      {"a moving ball", point + glass + "ActiveTransform EndTime\nTranslate 0.4 0 0.1\nActiveTransform All\n" + ball},
      {"two lights",
       point + "LightSource \"distant\" \"rgb L\" [ 1 4 2 ] \"point3 from\" [ -0.5 2 0.3 ] \"point3 to\" [ 0 0 0 ]\n" +
           glass + ball,
       2, 256, 1.2},
  };
}

// Fails where a component of `m` differs from that of `other`, or would not differ with this factor of it.
void expect_same(const Mean& m, const Mean& other, double fault, double level, const std::string& what) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::ostringstream text;
    text << what << ", component " << k << ": " << m.mean[k] << " +- " << m.standard_error[k] << ", other "
         << other.mean[k] << " +- " << other.standard_error[k];
    if (std::getenv("MONTELUX_SHOW")) std::printf("%s\n", text.str().c_str());
    EXPECT_GT(p_value_of_difference(m, other, k, 1), level) << text.str();
    EXPECT_LT(p_value_of_difference(m, other, k, fault), level) << text.str();
  }
}

TEST(ManifoldLight, finds_the_light_that_light_tracing_finds) {
  const std::vector<Case> all = cases();
  const double own = sidak_level(family_level, 3.0 * double(all.size()));
  for (const Case& c : all) {
    SCOPED_TRACE(c.name);
    const TestScene scene(head + floor_patch + c.world);
    const std::string depth = "maxdepth=" + std::to_string(c.length + 1);
    const Mean light = measure(scene, "light:" + depth, 2048, 11);
    const Mean m = measure(scene, "path:manifold=" + std::to_string(c.length) + "," + depth, c.samples, 12);
    const Mean without = measure(scene, "path:" + depth, c.samples, 13);
    expect_same(m, light, c.fault, own, c.name);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT(p_value_of_difference(without, light, k, 1), own) << k << ": " << without.mean[k];
  }
}

// ---- slightly rough surfaces

std::string rough(const std::string& material, double alpha) {
  return "Material " + material + " \"float roughness\" [ " + std::to_string(alpha) +
         " ] \"bool remaproughness\" false\n";
}
const std::string rough_glass = "\"dielectric\" \"float eta\" [ 1.2 ]";
const std::string rough_gold = "\"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"";

std::vector<Case> rough_cases() {
  const auto pane = [](double y) {
    const std::string at = " " + std::to_string(y) + " ";
    return "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2  0 2 3 ] \"point3 P\" [ -3" + at + "-3  -3" + at +
           "3  3" + at + "3  3" + at + "-3 ]\n";
  };
  const std::string ball = "Shape \"sphere\" \"float radius\" [ 1 ]\n";
  return {
      {"a ball", point + rough(rough_glass, 0.1) + ball},
      {"a ball of triangles", point + rough(rough_glass, 0.05) + tessellated_sphere(32, 48)},
      {"a ball of coloured glass",
       point + rough("\"tinteddielectric\" \"float eta\" [ 1.3 ] \"rgb tint\" [ 0.9 0.5 0.2 ]", 0.1) + ball},
      {"a pane that is rough on one side",
       point + rough(rough_glass, 0.2) + pane(0.2) + "Material \"dielectric\" \"float eta\" [ 1.2 ]\n" + pane(-0.2)},
      {"a ring of gold",
       "LightSource \"spot\" \"rgb I\" [ 3 1 5 ] \"point3 from\" [ 1.2 -0.8 0.1 ] \"point3 to\" [ -0.6 -1.6 0 ] "
       "\"float coneangle\" [ 40 ]\n" +
           rough(rough_gold, 0.15) +
           "Translate 0 -1.9 0\nRotate -90 1 0 0\nShape \"cylinder\" \"float radius\" [ 0.7 ] \"float zmin\" [ 0 ] "
           "\"float zmax\" [ 0.4 ]\n",
       1},
      {"a mirror with normals",
       "LightSource \"distant\" \"rgb L\" [ 3 1 5 ] \"point3 from\" [ -1 1 0.2 ] \"point3 to\" [ 0.9 -1.2 0 ]\n" +
           rough(rough_gold, 0.2) +
           "Translate 0.9 -1.2 0\nShape \"bilinearmesh\" \"point3 P\" [ 0 -0.5 -0.6  0 -0.5 0.6  0.3 0.7 -0.6  0.3 0.6 "
           "0.6 ] \"normal N\" [ -1 0.2 0.1  -1 0.1 -0.1  -2 0.6 0.1  -1 0.3 -0.1 ]\n",
       1},
  };
}

TEST(ManifoldLight, passes_slightly_rough_surfaces_as_light_tracing_does) {
  const std::vector<Case> all = rough_cases();
  const double own = sidak_level(family_level, 3.0 * double(all.size()));
  for (const Case& c : all) {
    SCOPED_TRACE(c.name);
    const TestScene scene(head + floor_patch + c.world);
    const std::string depth = "maxdepth=" + std::to_string(c.length + 1);
    const Mean light = measure(scene, "light:" + depth, 4096, 11);
    const std::string way = "path:manifold=" + std::to_string(c.length) + "," + depth;
    const Mean m = measure(scene, way + ",manifold-roughness=0.3", c.samples, 12);
    expect_same(m, light, c.fault, own, c.name);
  }
}

// Where rough mirrors are seen by way of each other and through rough glass, all tails of paths occur.
TEST(ManifoldLight, counts_each_path_once_where_chains_may_begin_at_rough_mirrors) {
  const TestScene scene(
      "Film \"rgb\" \"integer xresolution\" [ 16 ] \"integer yresolution\" [ 16 ]\nPixelFilter \"box\"\n"
      "LookAt 0 1.5 -4  0 0.3 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n"
      "LightSource \"point\" \"rgb I\" [ 5 4 2 ] \"point3 from\" [ 0.5 3 -0.5 ]\n"
      "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.3 0.15 ]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ -3 -0.5 -3  -3 -0.5 3  3 -0.5 -3  3 -0.5 3 ]\n" +
      rough(rough_gold, 0.3) +
      "Shape \"bilinearmesh\" \"point3 P\" [ -2 -0.5 1.5  2 -0.5 1.5  -2 2 1.5  2 2 1.5 ]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ -2 -0.5 1.5  -2 -0.5 -1.5  -2 2 1.5  -2 2 -1.5 ]\n" +
      rough(rough_glass, 0.25) +
      "Shape \"bilinearmesh\" \"point3 P\" [ -1 0.9 -1.2  1 0.8 -1.2  -1 0.8 1  1 0.9 1 ]\n");
  const Mean path = measure(scene, "path:maxdepth=5", 1024, 21);
  const double own = sidak_level(family_level, 6);
  for (int length = 1; length <= 2; ++length) {
    const std::string way = "path:maxdepth=5,manifold=" + std::to_string(length) + ",manifold-roughness=0.3";
    expect_same(measure(scene, way, 256, 22), path, 1.03, own, way);
  }
}

// One path a lane and one path alone give the same bits.
TEST(ManifoldLight, does_not_depend_on_the_lanes) {
  const TestScene scene(head + floor_patch + cases()[0].world);
  RenderObserver silent;
  const auto image = [&](const std::string& lanes) {
    const ChosenIntegrator chosen = scene.integrator("path:manifold=2,lanes=" + lanes);
    return render(chosen.any(), scene.settings(PointSetKind::independent, {4, 2}, 3), silent).film.image();
  };
  const ImageEstimate one = image("one"), native = image("native");
  EXPECT_GT(one.mean[0], 0);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(one.mean[k], native.mean[k]);
}

}  // namespace
}  // namespace montelux::test
