// A room for integrators whose paths start at lights, and the comparison of pictures of it.
#pragma once
#include <gtest/gtest.h>

#include "pass_means.h"

namespace montelux::test {

// A coloured room with lamps of many kinds, a thin lens, surfaces with shading normals, translucent and layered ones,
// and an opening to the sky; a glass ball that is not in view throws a caustic.
inline std::string room(const std::string& camera, const std::string& filter) {
  return R"(Film "rgb" "integer xresolution" 24 "integer yresolution" 16
PixelFilter )" +
         filter + R"(
LookAt 0 1.2 -1.9  0 0.7 0.5  0 1 0
)" + camera +
         R"(
WorldBegin
LightSource "infinite" "rgb L" [ 0.3 0.5 0.9 ]
LightSource "spot" "rgb I" [ 2 0.5 0.3 ] "point3 from" [ -0.8 1.8 -0.5 ] "point3 to" [ 0.3 0 0.8 ] "float coneangle" 40
LightSource "distant" "rgb L" [ 0.6 0.6 0.2 ] "point3 from" [ 0.3 1 -0.2 ] "point3 to" [ 0 0 0 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 3 4 2 ] "bool twosided" true
  Material "diffuse" "rgb reflectance" [ 0.1 0.1 0.1 ]
  Translate 0.7 1.4 0.9
  Shape "sphere" "float radius" 0.15
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 6 2 2 ]
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Shape "bilinearmesh" "point3 P" [ -0.9 1.7 0.4  -0.5 1.7 0.4  -0.9 1.75 0.8  -0.5 1.75 0.8 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.5 0.3 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -2  1 0 -2  -1 0 2  1 0 2 ]
Material "diffuse" "rgb reflectance" [ 0.8 0.1 0.1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -2  -1 2 -2  -1 0 2  -1 2 2 ]
Material "coateddiffuse" "rgb reflectance" [ 0.1 0.7 0.2 ] "float roughness" 0.4
Shape "bilinearmesh" "point3 P" [ 1 0 -2  1 2 -2  1 0 2  1 2 2 ]
Material "diffusetransmission" "rgb reflectance" [ 0.2 0.2 0.5 ] "rgb transmittance" [ 0.3 0.2 0.2 ]
Shape "bilinearmesh" "point3 P" [ -1 0 2  1 0 2  -1 2 2  1 2 2 ]
Material "conductor" "float roughness" 0.5
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ -0.8 0 1.2  0 0 1.5  0 0.9 1.5  -0.8 0.9 1.2 ]
  "normal N" [ -0.5 0.2 -1  0.5 0.1 -1  0.6 -0.2 -1  -0.4 0.3 -1 ]
Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ 0.1 0 0.4  0.7 0 0.6  0.7 0.5 0.6  0.1 0.5 0.4 ]
  "normal N" [ -1 0.8 -0.5  1 0.8 -0.5  1 0.8 -0.5  -1 0.8 -0.5 ]
Material "dielectric"
AttributeBegin
  Translate -0.3 1.55 -2.6
  Shape "sphere" "float radius" 0.25
AttributeEnd
)";
}
inline const std::string gaussian = "\"gaussian\"",
                         lens = R"(Camera "perspective" "float fov" 60 "float lensradius" 0.05
  "float focaldistance" 2.5)";

// Fog around the camera, a cloud of another sort in it with a lamp at one point, and an area light.
inline const std::string fog_with_cloud = R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 0.1 0.05 0.2 ] "rgb sigma_s" [ 0.2 0.3 0.5 ]
  "float g" 0.5
MakeNamedMedium "cloud" "string type" "homogeneous" "rgb sigma_a" [ 0 0.1 0.1 ] "rgb sigma_s" [ 2 1 0.5 ]
MediumInterface "" "fog"
LookAt 0 1 -3   0 1 0   0 1 0
Camera "perspective" "float fov" 50
WorldBegin
MediumInterface "fog" "fog"
LightSource "point" "rgb I" [ 3 2 1 ] "point3 from" [ 0 1 0 ]
AttributeBegin
  Material "interface"
  MediumInterface "cloud" "fog"
  Translate 0 1 0
  Shape "sphere" "float radius" 0.6
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 3 5 8 ] "bool twosided" true
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Shape "bilinearmesh" "point3 P" [ 0.8 1.8 -0.2  1.2 1.8 -0.2  0.8 1.6 0.2  1.2 1.6 0.2 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.5 0.3 ]
Shape "bilinearmesh" "point3 P" [ -3 0 -3  3 0 -3  -3 0 3  3 0 3 ]
Shape "bilinearmesh" "point3 P" [ -3 0 2  3 0 2  -3 4 2  3 4 2 ]
)";

// Passes as they come, each of `per_pass` frames.
inline PassMeans measured(const TestScene& scene, const std::string& way, int per_pass, int passes,
                          std::uint32_t seed) {
  return measure_passes(scene, scene.integrator(way), per_pass, passes, seed);
}
// The smallest p-value of the image, the blocks and the colours.
struct Comparison {
  double smallest = 1;
  std::size_t tests = 0;
  bool differ() const { return smallest < sidak_level(family_level, double(tests)); }
};
inline Comparison compared(const PassMeans& a, const PassMeans& b) {
  Comparison c;
  const auto test = [&](const std::vector<double>& x, const std::vector<double>& y) {
    c.smallest = std::min(c.smallest, welch_test(summarize(x), summarize(y)).p_value), ++c.tests;
  };
  EXPECT_EQ(a.values.size(), b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i) test(a.values[i], b.values[i]);
  for (std::size_t i = 0; i < a.colours.size(); ++i) test(a.colours[i], b.colours[i]);
  EXPECT_EQ(a.non_finite + b.non_finite, 0u);
  return c;
}

}  // namespace montelux::test
