// Lights that are chosen by what is learned of which are hidden: the same light as path, with less noise.
#include <gtest/gtest.h>

#include "pass_means.h"
#include "render/render.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

// Six chambers in a row, open toward the camera, each with coloured lamps at one of its walls: on the other side of
// the wall these are near, and hidden. `more`: what else is in it.
std::string chambers(const std::string& more, bool has_lamps = true) {
  std::string text = R"(
LookAt 3 1.1 -4.5  3 0.9 0  0 1 0
Camera "perspective" "float fov" [ 60 ]
Film "rgb" "integer xresolution" [ 32 ] "integer yresolution" [ 24 ]
PixelFilter "box"
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -2  -1 0 1  7 0 -2  7 0 1 ]
Shape "bilinearmesh" "point3 P" [ -1 2 -2  7 2 -2  -1 2 1  7 2 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 1  -1 2 1  7 0 1  7 2 1 ]
)";
  for (int i = 0; i < 6; ++i) {
    const std::string x = std::to_string(i) + " ", next = std::to_string(i + 1) + " ";
    const char* colours[] = {"[ 9 3 1 ]", "[ 2 8 3 ]", "[ 1 3 9 ]"};
    text += "Material \"diffuse\" \"rgb reflectance\" [ 0.7 0.7 0.6 ]\nShape \"bilinearmesh\" \"point3 P\" [ " + x +
            "0 -0.5 " + x + "2 -0.5 " + x + "0 1 " + x + "2 1 ]\n";
    // Some of them may be seen by rays alone or by samples alone.
    for (int k = 0; k < 4 && has_lamps; ++k) {
      const std::string y = k < 2 ? "1.7 " : "0.4 ", z = k % 2 == 0 ? "0.8" : "0.2";
      const std::string at = std::to_string(i) + (k < 2 ? ".07 " : ".15 ") + y + z;
      if (k == 3)
        text += "LightSource \"point\" \"rgb I\" " + std::string(colours[(i + k) % 3]) +
                " \"float scale\" 0.05 \"point3 from\" [ " + at + " ]\n";
      else
        text += "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" " + std::string(colours[(i + k) % 3]) +
                "\nTranslate " + at + "\nShape \"sphere\" \"float radius\" 0.05\nAttributeEnd\n";
    }
  }
  return text + R"(
Material "coateddiffuse" "rgb reflectance" [ 0.2 0.4 0.5 ] "float roughness" [ 0.2 ]
AttributeBegin
  Translate 0.5 0.3 -0.8
  Shape "sphere" "float radius" [ 0.3 ]
AttributeEnd
Material "diffusetransmission" "rgb reflectance" [ 0.3 0.3 0.1 ] "rgb transmittance" [ 0.2 0.4 0.1 ]
Shape "bilinearmesh" "point3 P" [ 1.4 0.2 -0.9  2 0.4 -0.8  1.4 1.2 -0.7  2 1 -0.9 ]
)" + more;
}

double relative_squared_error(const TestScene& scene, const std::string& way) {
  RenderObserver silent;
  const ChosenIntegrator chosen = scene.integrator(way);
  const RenderResult result = render(chosen.any(), scene.settings(PointSetKind::blue_noise, {16, 32}, 3, 0), silent);
  return result.film.error().relative_mse;
}

TEST(LightLearning, estimates_the_same_light_as_path_with_less_noise) {
  const TestScene clear(chambers("")), under_sky(chambers("LightSource \"infinite\" \"rgb L\" [ 0.2 0.3 0.5 ]\n"));
  const TestScene hazy(chambers(R"(
MakeNamedMedium "haze" "string type" "homogeneous" "rgb sigma_a" [ 0.1 0.1 0.2 ] "rgb sigma_s" [ 0.5 0.6 0.8 ]
AttributeBegin
  Translate 2 1 -0.7
  Material "interface"
  MediumInterface "haze" ""
  Shape "sphere" "float radius" [ 0.7 ]
AttributeEnd
)"));
  // Most of what the camera sees is in the shade.
  const TestScene sunny(
      chambers("LightSource \"infinite\" \"rgb L\" [ 0.2 0.3 0.5 ]\nLightSource \"distant\" \"rgb L\" [ 3 2 1 ] "
               "\"point3 from\" [ -0.4 1 -0.5 ]\n",
               false));
  const std::string learned = "path:light-selection=learned,light-paths=30000";
  const double level = sidak_level(3e-3, 5);
  for (const auto& [name, scene] : {std::pair("clear", &clear), std::pair("hazy", &hazy), std::pair("sky", &under_sky),
                                    std::pair("sunny", &sunny)}) {
    const PassMeans plain = measure_passes(*scene, scene->integrator("path"), 16, 96, 1);
    for (const std::string more : {"", ",mis=balance,sky-learning=on,sky-paths=4096,guiding=on,guiding-paths=8000"}) {
      if (scene != &under_sky && !more.empty()) continue;
      SCOPED_TRACE(name + more);
      expect_same_means(measure_passes(*scene, scene->integrator(learned + more), 16, 96, 2), plain, level);
    }
  }
  EXPECT_LT(relative_squared_error(clear, learned), 0.95 * relative_squared_error(clear, "path"));
  EXPECT_LT(relative_squared_error(sunny, learned), 0.9 * relative_squared_error(sunny, "path"));
}

}  // namespace
}  // namespace montelux::test
