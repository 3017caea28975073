// Small scenes in which reuse between pixels may go wrong: pixels that see different lights, different sides of lights,
// different materials.
#pragma once
#include <fmt/format.h>

#include "render_scenes.h"

namespace montelux::test {

struct ReuseScene {
  std::string name, text;
};
inline void PrintTo(const ReuseScene& s, std::ostream* out) { *out << s.name; }

inline std::string reuse_scene_head(int size, const char* camera, int max_depth) {
  return fmt::format(R"({}
Film "rgb" "integer xresolution" [ {} ] "integer yresolution" [ {} ]
PixelFilter "box"
Integrator "path" "integer maxdepth" [ {} ]
WorldBegin
)",
                     camera, size, size, max_depth);
}

// The head of a scene whose camera goes from one place to another; both as the words of LookAt.
inline std::string moving_camera_head(int size, const char* start, const char* end, int fov) {
  return fmt::format(R"(Film "rgb" "integer xresolution" [ {0} ] "integer yresolution" [ {0} ]
PixelFilter "box"
ActiveTransform StartTime
LookAt {1}
ActiveTransform EndTime
LookAt {2}
ActiveTransform All
Camera "perspective" "float fov" [ {3} ]
)",
                     size, start, end, fov);
}

inline constexpr const char* reuse_camera =
    R"(LookAt 0 1.6 -4  0 0.6 0  0 1 0
Camera "perspective" "float fov" [ 45 ])";

// `side` x `side` small coloured triangles under a low ceiling, some of them hidden by boards: every pixel has lights
// of its own.
inline std::string many_triangles(int side) {
  std::string text;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double x = -2 + 4.0 * (i + 0.3) / side, z = -2 + 4.0 * (j + 0.6) / side, r = 0.25 * 4.0 / side;
      const double strength = 2 + 30.0 * ((i * 7 + j * 13) % 11 == 0);
      text += fmt::format(R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ {} {} {} ]
Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point3 P" [ {} 1.2 {}  {} 1.2 {}  {} {} {} ]
AttributeEnd
)",
                          strength, strength * (0.4 + 0.6 * ((i + j) % 2)), strength * (0.3 + 0.2 * (i % 3)), x, z,
                          x + r, z, x, j % 3 == 0 ? 1.0 : 1.2, z + r);
    }
  return text;
}

inline std::string reuse_floor(const char* material) {
  return std::string(material) + "\nShape \"bilinearmesh\" \"point3 P\" [ -3 0 -3  3 0 -3  -3 0 3  3 0 3 ]\n";
}

// Coats under which light walks at random, so that value and density are estimates: of a rough and a smooth coat, over
// metal and Lambert's law, with scatterers and without. Where few events are allowed, many walks do not come out, and
// the estimated density is far from that of directions.
inline std::string walked_coats() {
  return reuse_floor(
             R"(Material "coatedconductor" "float interface.roughness" [ 0.1 ] "float conductor.roughness" [ 0.1 ]
    "float thickness" [ 0.3 ] "float g" [ 0.3 ] "rgb albedo" [ 0.8 0.7 0.5 ] "integer maxdepth" [ 3 ])") +
         R"(AttributeBegin
Translate -0.6 0.45 -0.5
Material "coateddiffuse" "float roughness" [ 0.2 ] "rgb reflectance" [ 0.5 0.3 0.2 ]
    "float thickness" [ 0.5 ] "rgb albedo" [ 0.9 0.8 0.9 ]
Shape "sphere" "float radius" [ 0.45 ]
AttributeEnd
AttributeBegin
Translate 0.5 0.4 -0.7
Material "coatedconductor" "float interface.roughness" [ 0 ] "float conductor.roughness" [ 0.15 ]
Shape "sphere" "float radius" [ 0.4 ]
AttributeEnd
AttributeBegin
Translate 0.9 0.35 0.5
Material "coateddiffuse" "float roughness" [ 0 ] "rgb reflectance" [ 0.3 0.5 0.6 ] "rgb albedo" [ 0.5 0.5 0.5 ]
    "integer maxdepth" [ 2 ]
Shape "sphere" "float radius" [ 0.35 ]
AttributeEnd
)";
}

inline std::vector<ReuseScene> reuse_scenes(int size) {
  const std::string head = reuse_scene_head(size, reuse_camera, 2);
  const char* grey = R"(Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ])";
  const std::string boards = R"(Material "diffuse" "rgb reflectance" [ 0.3 0.4 0.6 ]
Shape "bilinearmesh" "point3 P" [ -0.6 0 -0.5  0.2 0 -0.9  -0.6 0.8 -0.5  0.2 0.8 -0.9 ]
Shape "bilinearmesh" "point3 P" [ 0.5 0 0.4  1.1 0 -0.2  0.5 1.1 0.4  1.1 1.1 -0.2 ]
)";
  std::vector<ReuseScene> scenes;
  scenes.push_back({"many lights", head + many_triangles(8) + reuse_floor(grey) + boards});
  // Slats between two lamps and the floor: neighbours see different lamps, or parts of them.
  std::string slats;
  for (int i = 0; i < 6; ++i)
    slats += fmt::format("Shape \"bilinearmesh\" \"point3 P\" [ {0} 0.7 -2  {1} 0.7 -2  {0} 0.7 2  {1} 0.7 2 ]\n",
                         -2 + 0.7 * i, -2 + 0.7 * i + 0.4);
  scenes.push_back({"blockers", head + R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 12 10 8 ]
Shape "bilinearmesh" "point3 P" [ -1.5 2.5 -0.3  -0.9 2.5 -0.3  -1.5 2.5 0.3  -0.9 2.5 0.3 ]
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 4 6 12 ] "bool twosided" [ true ]
Shape "disk" "float radius" [ 0.3 ] "float height" [ 0 ]
AttributeEnd
AttributeBegin
Translate 1.2 2.2 0.4
AreaLightSource "diffuse" "rgb L" [ 4 6 12 ]
Shape "sphere" "float radius" [ 0.2 ]
AttributeEnd
LightSource "point" "rgb I" [ 2 2 2 ] "point3 from" [ 0 3 0 ]
)" + reuse_floor(grey) + slats});
  scenes.push_back({"glossy", head + R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 3 3 3 ]
Shape "bilinearmesh" "point3 P" [ -1.5 0.4 2  -0.2 0.4 2  -1.5 1.4 2  -0.2 1.4 2 ]
Shape "sphere" "float radius" [ 0.05 ]
AttributeEnd
AttributeBegin
Translate 0.9 0.7 1.2
AreaLightSource "diffuse" "rgb L" [ 60 50 20 ]
Shape "sphere" "float radius" [ 0.08 ]
AttributeEnd
)" + reuse_floor(R"(Material "conductor" "float roughness" [ 0.08 ])") +
                                  R"(AttributeBegin
Translate -0.2 0.45 -0.6
Material "coateddiffuse" "float roughness" [ 0.15 ] "rgb reflectance" [ 0.5 0.2 0.1 ]
Shape "sphere" "float radius" [ 0.45 ]
AttributeEnd
)"});
  scenes.push_back({"textured emitter", head + R"(AttributeBegin
AreaLightSource "diffuse" "string filename" [ "right-half.png" ] "float scale" [ 9 ]
Shape "bilinearmesh" "point3 P" [ -1.5 1.8 -1  1.5 1.8 -1  -1.5 1.8 1.5  1.5 1.8 1.5 ]
Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point3 P" [ -2 0.1 1.9  -1 0.1 1.9  -2 1.2 1.9 ]
    "point2 uv" [ 0 0  1 0  0 1 ]
AttributeEnd
)" + reuse_floor(grey) + boards});
  scenes.push_back(
      {"two sides",
       head + R"(LightSource "infinite" "rgb L" [ 0.05 0.05 0.05 ]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 8 7 6 ] "bool twosided" [ true ]
Shape "bilinearmesh" "point3 P" [ -0.2 0.5 -0.6  0.6 0.5 -0.2  -0.2 1.1 -0.6  0.6 1.1 -0.2 ]
AttributeEnd
)" + reuse_floor(grey) +
           R"(Material "diffusetransmission" "rgb reflectance" [ 0.3 0.3 0.3 ] "rgb transmittance" [ 0.4 0.3 0.2 ]
Shape "bilinearmesh" "point3 P" [ -1.2 0 0.4  -0.4 0 -1.1  -1.2 1.2 0.4  -0.4 1.2 -1.1 ]
Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.7 ]
Shape "bilinearmesh" "point3 P" [ 0.9 0 -0.8  1.3 0 0.9  0.9 1.3 -0.8  1.3 1.3 0.9 ] "float alpha" [ 0.6 ]
)"});
  scenes.push_back(
      {"surroundings", head + R"(LightSource "infinite" "string filename" [ "right-half.png" ] "float scale" [ 0.8 ]
LightSource "distant" "rgb L" [ 0.5 0.5 0.4 ] "point3 from" [ 1 2 -1 ]
AttributeBegin
Translate -0.8 0.9 0.3
AreaLightSource "diffuse" "rgb L" [ 6 3 2 ]
Shape "sphere" "float radius" [ 0.15 ]
AttributeEnd
)" + reuse_floor(grey) + boards});
  scenes.push_back({"walked coats", head + R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 5 5 5 ]
Shape "bilinearmesh" "point3 P" [ -1.5 0.4 2  -0.2 0.4 2  -1.5 1.4 2  -0.2 1.4 2 ]
AttributeEnd
AttributeBegin
Translate 0.9 1.4 -0.6
AreaLightSource "diffuse" "rgb L" [ 12 10 6 ]
Shape "sphere" "float radius" [ 0.15 ]
AttributeEnd
LightSource "infinite" "rgb L" [ 0.4 0.5 0.6 ]
)" + walked_coats()});
  // The first rough surface is behind a mirror, glass, or an interface.
  scenes.push_back({"specular first", reuse_scene_head(size, reuse_camera, 4) + R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 9 9 7 ]
Shape "bilinearmesh" "point3 P" [ -0.6 2.3 -0.6  0.6 2.3 -0.6  -0.6 2.3 0.6  0.6 2.3 0.6 ]
AttributeEnd
)" + reuse_floor(grey) + R"(AttributeBegin
Translate -0.7 0.5 0
Material "conductor" "float roughness" [ 0 ]
Shape "sphere" "float radius" [ 0.5 ]
AttributeEnd
AttributeBegin
Translate 0.7 0.5 -0.2
Material "dielectric"
Shape "sphere" "float radius" [ 0.45 ]
AttributeEnd
AttributeBegin
Translate 0 0.4 -0.9
Material "interface"
Shape "sphere" "float radius" [ 0.35 ]
AttributeEnd
)" + boards});
  return scenes;
}

}  // namespace montelux::test
