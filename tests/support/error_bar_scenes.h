// Tiny scenes on which error bars are put to the test.
#pragma once
#include "render_scenes.h"

namespace montelux::test {

struct ErrorBarScene {
  std::string name, text;
};
inline void PrintTo(const ErrorBarScene& s, std::ostream* out) { *out << s.name; }

inline const std::string error_bar_head =
    "Film \"rgb\" \"integer xresolution\" [ 16 ] \"integer yresolution\" [ 16 ]\n"
    "PixelFilter \"gaussian\"\nIntegrator \"path\"\n";

// Two hundred small lamps over a floor with posts: which lamp matters changes from point to point.
inline std::string lamps(const std::string& look_at) {
  std::ostringstream s;
  s << look_at
    << "Camera \"perspective\" \"float fov\" [ 50 ]\nWorldBegin\n"
       "LightSource \"infinite\" \"rgb L\" [ 0.02 0.02 0.02 ]\n"
       "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.6 0.6 ]\n"
       "Shape \"bilinearmesh\" \"point3 P\" [ -9 0 -9  9 0 -9  -9 0 9  9 0 9 ]\n";
  for (int i = 0; i < 200; ++i)
    s << "AttributeBegin\nTranslate " << -4.75 + 0.5 * (i % 20) << ' ' << 1 + 0.1 * (i * 7 % 10) << ' '
      << -2.25 + 0.5 * (i / 20) << "\nAreaLightSource \"diffuse\" \"rgb L\" [ " << 1 + i % 5 << ' ' << 1 + i % 5 << ' '
      << 1 + i % 5 << " ]\nShape \"sphere\" \"float radius\" [ 0.05 ]\nAttributeEnd\n";
  for (int i = 0; i < 6; ++i)
    s << "AttributeBegin\nTranslate " << -1.25 + 0.5 * i << " 0 " << -1 + 0.4 * (i % 3 - 1)
      << "\nRotate -90 1 0 0\nShape \"cylinder\" \"float radius\" [ 0.1 ] \"float zmin\" [ 0 ] \"float zmax\" [ 0.5 ]\n"
         "AttributeEnd\n";
  return s.str();
}

inline const std::vector<ErrorBarScene>& error_bar_scenes() {
  static const std::vector<ErrorBarScene> scenes{
      // A white box with a lamp and two things in it: light from everywhere, soft shadows, long paths.
      {"box", error_bar_head + R"(
LookAt 0 0 -3.4  0 0 0  0 1 0
Camera "perspective" "float fov" [ 40 ]
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 12 12 12 ]
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]
    "point3 P" [ -0.3 0.98 -0.3  0.3 0.98 -0.3  0.3 0.98 0.3  -0.3 0.98 0.3 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.7 ]
Shape "bilinearmesh" "integer indices" [ 0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7 ]
  "point3 P" [ -1 -1 -4  1 -1 -4  -1 1 -4  1 1 -4  -1 -1 1  1 -1 1  -1 1 1  1 1 1 ]
AttributeBegin
  Translate -0.4 -0.6 0.2
  Material "conductor" "float roughness" [ 0.3 ]
  Shape "sphere" "float radius" [ 0.4 ]
AttributeEnd
AttributeBegin
  Translate 0.5 -0.7 -0.3
  Shape "sphere" "float radius" [ 0.3 ]
AttributeEnd
)"},
      // Under an even sky with a soft sun: a ball on a plane.
      {"sky", error_bar_head + R"(
LookAt 0 1.2 -4  0 0.4 0  0 1 0
Camera "perspective" "float fov" [ 40 ]
WorldBegin
LightSource "infinite" "rgb L" [ 0.5 0.5 0.5 ]
AttributeBegin
  Translate 30 40 -20
  AreaLightSource "diffuse" "rgb L" [ 60 60 60 ]
  Shape "sphere" "float radius" [ 4 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -20 0 -20  20 0 -20  -20 0 20  20 0 20 ]
AttributeBegin
  Translate 0 0.7 0
  Material "coateddiffuse" "rgb reflectance" [ 0.6 0.6 0.6 ] "float roughness" [ 0.3 ]
  Shape "sphere" "float radius" [ 0.7 ]
AttributeEnd
)"},
      {"lamps", error_bar_head + lamps("LookAt 0 0.9 -2.5  0 0 -1  0 1 0\n")}};
  return scenes;
}

// The lamps themselves in view, each much smaller than a pixel: few samples meet one.
inline ErrorBarScene specks_scene() { return {"specks", error_bar_head + lamps("LookAt 0 3 -6  0 0 0  0 1 0\n")}; }

// The mean of many renders by the best point set, with seeds of their own: pixels and their variances.
struct Truth {
  std::vector<double> mean, variance;
  double image = 0, image_error = 0;
};
inline Truth truth_of(const Film& film) {
  Truth t;
  const PixelBounds& b = film.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      t.mean.push_back(film.pixel(x, y).mean[0]);
      t.variance.push_back(film.pixel(x, y).variance_of_mean(0));
    }
  t.image = film.image().mean[0], t.image_error = film.image().standard_error[0];
  return t;
}
// By the integrator of this name and settings, or by path tracing.
inline Truth truth_of(const TestScene& scene, PassPlan plan, std::string_view integrator) {
  const ChosenIntegrator chosen = scene.integrator(integrator);
  RenderObserver silent;
  return truth_of(render(chosen.any(), scene.settings(PointSetKind::padded_sobol, plan, 0x7257u, 0), silent).film);
}
inline Truth truth_of(const TestScene& scene, PassPlan plan, std::optional<Shutter> shutter = {}) {
  const PathTracer path = scene.tracer();
  RenderSettings s = scene.settings(PointSetKind::padded_sobol, plan, 0x7257u, 0);
  s.image.shutter = shutter;
  RenderObserver silent;
  return truth_of(render(path, s, silent).film);
}

}  // namespace montelux::test
