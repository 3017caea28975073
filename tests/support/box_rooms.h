// A box with a lamp in its ceiling, and what may stand in it: for integrators that follow light from both ends.
#pragma once
#include <string>

namespace montelux::test {

// A box with a lamp in the ceiling.
inline std::string box(const std::string& contents) {
  return R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
LookAt 0 1 -0.95   0 0.8 1   0 1 0
Camera "perspective" "float fov" 75
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 3 2.5 2 ]
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Shape "bilinearmesh" "point3 P" [ -0.5 1.98 -0.5  0.5 1.98 -0.5  -0.5 1.98 0.5  0.5 1.98 0.5 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.6 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  1 0 -1  -1 0 1  1 0 1 ]
Shape "bilinearmesh" "point3 P" [ -1 2 -1  1 2 -1  -1 2 1  1 2 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 1  1 0 1  -1 2 1  1 2 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  1 0 -1  -1 2 -1  1 2 -1 ]
Material "diffuse" "rgb reflectance" [ 0.6 0.1 0.1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  -1 2 -1  -1 0 1  -1 2 1 ]
Material "diffuse" "rgb reflectance" [ 0.1 0.5 0.1 ]
Shape "bilinearmesh" "point3 P" [ 1 0 -1  1 2 -1  1 0 1  1 2 1 ]
)" + contents;
}
inline std::string ball(const std::string& material, double x, double z, const std::string& emission = "") {
  return "AttributeBegin\n" + emission + "Material " + material + "\nTranslate " + std::to_string(x) + " 0.45 " +
         std::to_string(z) + "\nShape \"sphere\" \"float radius\" 0.4\nAttributeEnd\n";
}

// A room that is full of fog, with a lamp and a mirror in it, and clearer air in a ball. Without lights at points:
// `path` does not find them in the mirror, and next to them its estimate has no finite variance.
inline const std::string& foggy_room() {
  static const std::string text = [] {
    std::string t = box(ball("\"conductor\" \"float roughness\" 0", 0.5, 0.5));
    t.insert(t.find("LookAt"), R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 0.1 0.05 0.3 ]
  "rgb sigma_s" [ 0.3 0.5 0.9 ] "float g" 0.4
MakeNamedMedium "air" "string type" "homogeneous" "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 0.2 0 0.1 ] "float g" -0.3
MediumInterface "" "fog"
)");
    t.insert(t.find("WorldBegin") + 10, "\nMediumInterface \"fog\" \"fog\"");
    t += R"(AttributeBegin
Material "interface"
MediumInterface "air" "fog"
Translate -0.4 0.9 0.2
Shape "sphere" "float radius" 0.5
AttributeEnd
)";
    return t;
  }();
  return text;
}

}  // namespace montelux::test
