// Next-event estimation by a learned field of the sky estimates the same light as path, with less noise where a window
// shows the sky.
#include <gtest/gtest.h>

#include "pass_means.h"
#include "render/render.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

// A room with a window, a sun, a small lamp, a glossy table and a glass ball; `more`: what else is in it.
std::string room(const std::string& more) {
  return R"(
LookAt 0 1 -1.8  0 0.8 0  0 1 0
Camera "perspective" "float fov" [ 70 ]
Film "rgb" "integer xresolution" [ 32 ] "integer yresolution" [ 24 ]
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [ 2 3 4 ]
LightSource "distant" "rgb L" [ 3 2 1 ] "point3 from" [ 4 3 1 ] "point3 to" [ 0 0 0 ]

MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [ 0.7 0.65 0.5 ]
MakeNamedMaterial "satin" "string type" "coateddiffuse" "rgb reflectance" [ 0.2 0.4 0.5 ] "float roughness" [ 0.2 ]
MakeNamedMaterial "brass" "string type" "conductor" "spectrum eta" "metal-CuZn-eta" "spectrum k" "metal-CuZn-k" "float roughness" [ 0.3 ]
MakeNamedMaterial "leaf" "string type" "diffusetransmission" "rgb reflectance" [ 0.3 0.3 0.1 ] "rgb transmittance" [ 0.2 0.4 0.1 ]
NamedMaterial "satin"
Shape "bilinearmesh" "point3 P" [ -2 0 -2  -2 0 2  2 0 -2  2 0 2 ]
NamedMaterial "white"
Shape "bilinearmesh" "point3 P" [ -2 2 -2  2 2 -2  -2 2 2  2 2 2 ]
Shape "bilinearmesh" "point3 P" [ -2 0 2  -2 2 2  2 0 2  2 2 2 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2  2 0 -2  -2 2 -2  2 2 -2 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2  -2 2 -2  -2 0 2  -2 2 2 ]
# The wall with the window.
Shape "bilinearmesh" "point3 P" [ 2 0 -2  2 0 2  2 1 -2  2 1 2 ]
Shape "bilinearmesh" "point3 P" [ 2 1.6 -2  2 1.6 2  2 2 -2  2 2 2 ]
Shape "bilinearmesh" "point3 P" [ 2 1 -2  2 1 0.3  2 1.6 -2  2 1.6 0.3 ]
Shape "bilinearmesh" "point3 P" [ 2 1 1  2 1 2  2 1.6 1  2 1.6 2 ]
NamedMaterial "leaf"
Shape "bilinearmesh" "point3 P" [ -1.5 0.2 1  -1 0.4 1.2  -1.4 1.2 1.3  -1 1 1.1 ]
NamedMaterial "brass"
AttributeBegin
  Translate -0.8 0.4 0
  Shape "sphere" "float radius" [ 0.4 ]
AttributeEnd
Material "dielectric" "float eta" [ 1.5 ]
AttributeBegin
  Translate 0.3 0.4 -0.2
  Shape "sphere" "float radius" [ 0.4 ]
AttributeEnd
NamedMaterial "white"
AreaLightSource "diffuse" "rgb L" [ 12 8 4 ]
Shape "bilinearmesh" "point3 P" [ -1.5 1.9 0.5  -1.3 1.9 0.5  -1.5 1.9 0.7  -1.3 1.9 0.7 ]
)" + more;
}

double squared_error(const TestScene& scene, const ChosenIntegrator& chosen) {
  RenderObserver silent;
  return render(chosen.any(), scene.settings(PointSetKind::blue_noise, {16, 16}, 3, 0), silent).film.mse();
}

TEST(SkyLearning, estimates_the_same_light_as_path_with_less_noise) {
  const TestScene clear(room(""));
  const TestScene hazy(room(R"(
MakeNamedMedium "haze" "string type" "homogeneous" "rgb sigma_a" [ 0.1 0.1 0.2 ] "rgb sigma_s" [ 0.5 0.6 0.8 ]
AttributeBegin
  Translate 0 1 0
  Material "interface"
  MediumInterface "haze" ""
  Shape "sphere" "float radius" [ 0.9 ]
AttributeEnd
)"));
  const double level = sidak_level(3e-3, 3);
  for (const TestScene* scene : {&clear, &hazy}) {
    const ChosenIntegrator path = scene->integrator("path");
    const PassMeans plain = measure_passes(*scene, path, 16, 96, 1);
    for (const std::string settings : {"", ",mis=balance,light-selection=ris:3,guiding=on,guiding-paths=8000"}) {
      if (scene == &hazy && !settings.empty()) continue;
      SCOPED_TRACE(testing::Message() << (scene == &hazy ? "hazy " : "") << settings);
      const ChosenIntegrator learned = scene->integrator("path:sky-learning=on,sky-paths=30000" + settings);
      const PassMeans m = measure_passes(*scene, learned, 16, 96, 2);
      expect_same_means(m, plain, level);
      if (scene == &clear && settings.empty()) {
        EXPECT_LT(squared_error(*scene, learned), 0.7 * squared_error(*scene, path));
      }
    }
  }
}

}  // namespace
}  // namespace montelux::test
