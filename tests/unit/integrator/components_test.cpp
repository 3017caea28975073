// Transport treats the components of what a path carries alike: equal ones stay equal, bit for bit, whatever the path
// meets. A output of parameters that is not as wide as a spectrum, or a loop over three components of four, shows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>

#include "integrator/path/loop.h"
#include "measured_files.h"
#include "render_scenes.h"
#include "temporary_folder.h"

namespace montelux {
namespace {

using namespace test;

// Every model of a surface, constant and textured, in a medium, between lights of several kinds. `colour` gives three
// numbers from one.
template <class Colour>
std::string scene_of(Colour colour) {
  const auto rgb = [&](const char* name, double x) { return fmt::format("\"rgb {}\" [ {} ] ", name, colour(x)); };
  std::string text = R"(Film "rgb" "integer xresolution" [ 24 ] "integer yresolution" [ 16 ]
LookAt 0 1 -9   0 0 0   0 1 0
Camera "perspective" "float fov" [ 40 ]
)";
  text += "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" " + rgb("sigma_a", 0.03) + rgb("sigma_s", 0.05) +
          rgb("Le", 0.2) + "\"float g\" [ 0.3 ]\nMediumInterface \"\" \"fog\"\nWorldBegin\n";
  text += "LightSource \"infinite\" " + rgb("L", 0.4) + "\n";
  text += "LightSource \"point\" " + rgb("I", 9) + "\"point3 from\" [ 0 4 -3 ]\n";
  text += "LightSource \"spot\" " + rgb("I", 9) + "\"point3 from\" [ 3 4 -3 ]\n";
  text += "AttributeBegin\nAreaLightSource \"diffuse\" " + rgb("L", 4) +
          "Translate 0 4 0\nShape \"sphere\" \"float radius\" [ 0.4 ]\nAttributeEnd\n";
  text += "Texture \"board\" \"spectrum\" \"checkerboard\" " + rgb("tex1", 0.8) + rgb("tex2", 0.1) +
          "\"float uscale\" [ 9 ] \"float vscale\" [ 9 ]\n";
  const std::string board = "\"texture reflectance\" \"board\" ";
  const std::string models[] = {
      "\"diffuse\" " + rgb("reflectance", 0.7),
      "\"diffuse\" " + board,
      "\"conductor\" \"float roughness\" [ 0.2 ] " + rgb("eta", 0.3) + rgb("k", 3),
      "\"conductor\" \"float roughness\" [ 0 ] " + board,
      "\"dielectric\" \"float eta\" [ 1.5 ]",
      "\"tinteddielectric\" \"float eta\" [ 1.4 ] " + rgb("tint", 0.7) + rgb("absorption", 0.4),
      "\"thindielectric\" " + rgb("tint", 0.6) + "\"float roughness\" [ 0.1 ]",
      "\"coateddiffuse\" " + rgb("reflectance", 0.6),
      "\"coateddiffuse\" " + board + rgb("albedo", 0.4) + "\"float roughness\" [ 0.1 ]",
      "\"coatedconductor\" " + rgb("conductor.eta", 0.3) + rgb("conductor.k", 3) + rgb("albedo", 0.3),
      "\"diffusetransmission\" " + rgb("reflectance", 0.4) + rgb("transmittance", 0.3),
      "\"phong\" " + rgb("kd", 0.3) + rgb("ks", 0.4),
      "\"metallicroughness\" " + rgb("basecolor", 0.6) + rgb("specularcolor", 0.8) + "\"float metallic\" [ 0.4 ]",
      "\"measured\" \"string filename\" [ \"table.bsdf\" ]",
      "\"coatedmetallicroughness\" " + rgb("basecolor", 0.5) + "\"float anisotropy\" [ 0.5 ]",
  };
  int i = 0;
  for (const std::string& model : models) {
    text += fmt::format("AttributeBegin\nTranslate {} {} 0\nMaterial {}\nShape \"sphere\" \"float radius\" [ 0.45 ]\n",
                        i % 5 - 2, i / 5 - 1, model);
    text += "AttributeEnd\n", ++i;
  }
  return text;
}

// Counts contributions, and those whose components do not have the bits that they should.
template <class Expected>
struct Watch {
  static constexpr bool records = true;
  Expected expected;
  int seen = 0, wrong = 0;

  template <class F>
  void add(Mask<F> on, const Spectrum<F>& light, const LightOrigin<F>&) {
    for_each_lane(on, [&](int k) {
      const Spectrum<float> x = lane(light, k), y = expected(x);
      ++seen;
      if (std::memcmp(x.c, y.c, sizeof(x.c)) != 0) ++wrong;
    });
  }
  void finish(int, std::uint32_t, PixelSample&) {}
};

// A folder with the table of a measured material of these channels.
class Folder : public TemporaryFolder {
 public:
  explicit Folder(const std::array<double, 3>& channels) {
    write("table.bsdf", measured_file({0.4, 0.4, {}, channels}, {.elevations = 3, .facets = 9, .values = 5}));
  }
};

template <class F, class Expected>
void expect_of_all_light(const TestScene& scene, Expected expected) {
  const PictureSettings& picture = scene.picture();
  const TilePass pass{picture.crop, {PointSetKind::independent, 5, 0, 16}};
  std::vector<PixelSample> out(std::size_t(picture.crop.area()) * 16);
  PathSettings settings;
  settings.max_depth = 8;
  Watch<Expected> watch{expected};
  trace_paths<F, true>(scene.scene(), scene.scene().lights, scene.accel(), settings, pass, out, watch);
  EXPECT_GT(watch.seen, 10000);
  EXPECT_EQ(watch.wrong, 0) << "of " << watch.seen;
}

TEST(Components, stay_equal_along_a_path_where_everything_is_grey) {
  const Folder folder({0.6, 0.6, 0.6});
  const TestScene scene(scene_of([](double x) { return fmt::format("{} {} {}", x, x, x); }), folder.path());
  const auto grey = [](const Spectrum<float>& x) { return gray(x.c[0]); };
  expect_of_all_light<float>(scene, grey);
  expect_of_all_light<NativeFloats>(scene, grey);
}

TEST(Components, beyond_blue_stay_equal_to_green) {
  const Folder folder({0.6, 0.5, 0.3});
  const TestScene scene(scene_of([](double x) { return fmt::format("{} {} {}", x, 0.8 * x, 0.5 * x); }), folder.path());
  const auto second_green = [](const Spectrum<float>& x) { return from_rgb(to_rgb(x)); };
  expect_of_all_light<float>(scene, second_green);
  expect_of_all_light<NativeFloats>(scene, second_green);
}

}  // namespace
}  // namespace montelux
