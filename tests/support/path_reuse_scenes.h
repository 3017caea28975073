// Small scenes in which the reuse of paths may go wrong: light comes by several events of different kinds.
#pragma once
#include "reuse_scenes.h"

namespace montelux::test {

inline std::vector<ReuseScene> path_reuse_scenes(int size) {
  const std::string head = reuse_scene_head(size, reuse_camera, 5);
  const std::string grey = R"(Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
)";
  const std::string walls = R"(Shape "bilinearmesh" "point3 P" [ -2 0 2  2 0 2  -2 3 2  2 3 2 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -3  -2 0 2  -2 3 -3  -2 3 2 ]
Shape "bilinearmesh" "point3 P" [ -2 3 -3  2 3 -3  -2 3 2  2 3 2 ]
)";
  std::vector<ReuseScene> scenes;
  // The lamp shines at the ceiling and the wall.
  scenes.push_back({"indirect", head + R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 30 25 20 ] "bool twosided" [ false ]
Shape "bilinearmesh" "point3 P" [ -1.3 1.9 0.4  -1.3 1.9 -0.4  -0.7 1.9 0.4  -0.7 1.9 -0.4 ]
AttributeEnd
)" + reuse_floor(grey.c_str()) + walls});
  // Lobes so narrow that most paths scatter again, and some that can be joined.
  scenes.push_back({"glossy", head + R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 12 11 9 ]
Shape "bilinearmesh" "point3 P" [ -1.2 2.6 -0.4  -0.2 2.6 -0.4  -1.2 2.6 0.6  -0.2 2.6 0.6 ]
AttributeEnd
LightSource "point" "rgb I" [ 1 1 2 ] "point3 from" [ 1.2 1.5 -0.5 ]
)" + reuse_floor(R"(Material "conductor" "float roughness" [ 0.15 ])") +
                                  grey + walls + R"(AttributeBegin
Translate 0.6 0.5 0
Material "coateddiffuse" "float roughness" [ 0.2 ] "rgb reflectance" [ 0.5 0.2 0.1 ]
Shape "sphere" "float radius" [ 0.5 ]
AttributeEnd
AttributeBegin
Translate -0.7 0.4 -0.4
Material "conductor" "float roughness" [ 0.05 ]
Shape "sphere" "float radius" [ 0.4 ]
AttributeEnd
)"});
  scenes.push_back({"walked coats", head + R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 12 11 9 ]
Shape "bilinearmesh" "point3 P" [ -1.2 2.6 -0.4  -0.2 2.6 -0.4  -1.2 2.6 0.6  -0.2 2.6 0.6 ]
AttributeEnd
LightSource "infinite" "rgb L" [ 0.1 0.15 0.2 ]
)" + walked_coats() + grey + walls});
  // Deltas between the first rough surface and the light, and before it.
  scenes.push_back({"mirrors and glass", head + R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 14 14 12 ]
Shape "bilinearmesh" "point3 P" [ -0.6 2.3 -0.6  0.6 2.3 -0.6  -0.6 2.3 0.6  0.6 2.3 0.6 ]
AttributeEnd
LightSource "infinite" "rgb L" [ 0.1 0.15 0.2 ]
)" + reuse_floor(grey.c_str()) + R"(AttributeBegin
Translate -0.7 0.5 0.2
Material "conductor" "float roughness" [ 0 ]
Shape "sphere" "float radius" [ 0.5 ]
AttributeEnd
AttributeBegin
Translate 0.7 0.5 0
Material "dielectric" "float roughness" [ 0 ]
Shape "sphere" "float radius" [ 0.45 ]
AttributeEnd
Material "dielectric" "float roughness" [ 0.3 ]
Shape "bilinearmesh" "point3 P" [ -0.3 0 -1  0.3 0 -1.1  -0.3 0.7 -1  0.3 0.7 -1.1 ]
)"});
  // Interfaces, one of which shines; mixtures, a sheet with holes, a sky with structure and lights that are deltas.
  scenes.push_back(
      {"interfaces", head + R"(LightSource "infinite" "string filename" [ "right-half.png" ] "float scale" [ 0.7 ]
LightSource "distant" "rgb L" [ 0.5 0.5 0.4 ] "point3 from" [ 1 2 -1 ]
MakeNamedMaterial "a" "string type" [ "diffuse" ] "rgb reflectance" [ 0.7 0.6 0.5 ]
MakeNamedMaterial "b" "string type" [ "conductor" ] "float roughness" [ 0.2 ]
Material "mix" "string materials" [ "a" "b" ] "float amount" [ 0.5 ]
Shape "bilinearmesh" "point3 P" [ -3 0 -3  3 0 -3  -3 0 3  3 0 3 ]
Material "interface"
AttributeBegin
Translate -0.5 0.8 0
Shape "sphere" "float radius" [ 0.5 ]
AttributeEnd
AttributeBegin
Translate 0.8 0.9 0
AreaLightSource "diffuse" "rgb L" [ 3 2 1 ]
Shape "sphere" "float radius" [ 0.3 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.7 ]
Shape "bilinearmesh" "point3 P" [ -0.8 0 0.7  0.6 0 0.9  -0.8 1.3 0.7  0.6 1.3 0.9 ]
Material "conductor" "float roughness" [ 0 ]
Shape "bilinearmesh" "point3 P" [ -1.9 0 -0.6  -1.3 0 0.9  -1.9 1.3 -0.6  -1.3 1.3 0.9 ]
)"});
  // Bands that face whatever ray meets them, close to a floor of very different squares: paths over them cannot be
  // joined, as each pixel meets another band.
  std::string bands;
  for (int i = 0; i < 5; ++i)
    bands += fmt::format(
        "Shape \"curve\" \"string type\" [ \"{2}\" ] \"float width\" [ 0.25 ] "
        "\"point3 P\" [ {0} 0.3 -2  {1} 0.25 -0.5  {0} 0.3 0.5  {1} 0.35 2 ]\n",
        -1.4 + 0.7 * i, -1.2 + 0.7 * i, i % 2 == 0 ? "flat" : "cylinder");
  scenes.push_back({"curves", head + R"(LightSource "distant" "rgb L" [ 2 2 1.8 ] "point3 from" [ 0.5 2 -0.6 ]
LightSource "infinite" "rgb L" [ 0.1 0.15 0.2 ]
Texture "checks" "spectrum" "checkerboard" "float uscale" [ 24 ] "float vscale" [ 24 ]
    "rgb tex1" [ 0.05 0.05 0.05 ] "rgb tex2" [ 0.9 0.8 0.7 ]
)" + reuse_floor(R"(Material "diffuse" "texture reflectance" [ "checks" ])") +
                                  "Material \"diffuse\" \"rgb reflectance\" [ 0.7 0.7 0.7 ]\n" + bands});
  return scenes;
}

}  // namespace montelux::test
