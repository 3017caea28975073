// Every setting of every integrator, changed, changes the picture: none is accepted and ignored.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "render_scenes.h"

namespace montelux::test {
namespace {

// Diffuse walls, a lamp, a point light, glass, and a glossy metal.
const char* room = R"(Film "rgb" "integer xresolution" 12 "integer yresolution" 12
LookAt 0 0 -2.4  0 0 0  0 1 0
Camera "perspective" "float fov" 60
WorldBegin
LightSource "point" "rgb I" [ 0.3 0.2 0.1 ] "point3 from" [ -0.6 0.5 -0.4 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 8 7 5 ]
  Shape "bilinearmesh" "point3 P" [ -0.3 0.95 -0.3  0.3 0.95 -0.3  -0.3 0.95 0.3  0.3 0.95 0.3 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.5 0.3 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 1  1 -1 1  -1 1 1  1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.2 0.6 0.4 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 -1  -1 -1 1  -1 1 -1  -1 1 1 ]
AttributeBegin
  Translate 0.5 -0.6 -0.2
  Material "dielectric" "float eta" 1.5
  Shape "sphere" "float radius" 0.35
AttributeEnd
AttributeBegin
  Translate -0.5 -0.6 0.2
  Material "conductor" "float roughness" 0.1
  Shape "sphere" "float radius" 0.35
AttributeEnd
)";
// The same without glass, metal and the point light, for integrators of diffuse surfaces.
std::string diffuse_room() {
  std::string text = room;
  text.erase(text.find("AttributeBegin\n  Translate 0.5"));
  return text;
}

// The same under a sky.
std::string sky_room() { return room + std::string("LightSource \"infinite\" \"rgb L\" [ 0.2 0.3 0.5 ]\n"); }

// With fog within the room, which the camera looks into.
std::string foggy_room() {
  std::string text = room;
  text.insert(text.find("WorldBegin"),
              "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [ .4 .3 .2 ]\n");
  return text +
         "Material \"interface\"\nMediumInterface \"fog\" \"\"\nTranslate 0 0 -0.1\nShape \"sphere\" \"float radius\" "
         "0.8\n";
}

// Values to try beside the default; the first that changes the picture is enough.
std::vector<std::string> values_of(const ParameterSpec& row) {
  const std::string name(row.name);
  if (name == "branching") return {"2/1"};
  if (name == "shadow-rays" && row.types.front() == ParameterType::string) return {"1/1"};
  if (name == "light-selection") return {"uniform", "ris:4"};
  if (name == "manifold") return {"1"};
  if (name == "roulette") return {"proportional"};
  if (name == "guiding-paths" || name == "sky-paths" || name == "light-paths") return {"4096"};
  std::vector<std::string> all;
  for (std::string_view choice : row.choices)
    if (choice != "none") all.emplace_back(choice);
  if (row.types.front() == ParameterType::boolean) return {"on", "off"};
  if (row.types.front() == ParameterType::string) return all;
  for (const double value : {1.0, 0.01, 3.0, 40.0, 0.6})
    if (value >= row.low && value <= row.high &&
        (row.types.front() != ParameterType::integer || value == std::floor(value)))
      all.push_back(fmt::format("{}", value));
  return all;
}

// Settings that change nothing in a single picture, each with the reason.
const std::map<std::string_view, std::string_view> without_effect{
    {"lanes", "the bits are the same for any number of lanes"},
    {"carry", "decides what the next picture of a sequence begins with"},
    {"pairs", "decides how well the bias is measured"},
    {"among", "of auto, which is chosen before there is an integrator"},
    {"share", "likewise"},
};

// What a setting needs beside it to have an effect.
std::string companions(std::string_view integrator, std::string_view setting) {
  if (setting == "m-cap" || setting == "warm-up") return integrator.starts_with("restir") ? "temporal=on" : "";
  if (setting == "candidates" && integrator == "direct") return "strategy=ris";
  if (setting == "mis" && integrator == "direct") return "strategy=mis";
  if (setting == "caustic-radius" || setting == "caustic-photons") return "gather-rays=2";
  if (setting == "alpha") return "frames=8";
  if (setting == "medium-radius") return "photons=20000";  // of the foggy room
  if (setting == "guiding-paths") return "guiding=on";
  if (setting == "sky-paths") return "sky-learning=on";
  if (setting == "light-paths") return "light-selection=learned";
  if (setting == "manifold-roughness") return "manifold=1";
  return "";
}

// Colours of all pixels.
std::vector<double> picture(const TestScene& scene, const std::string& way) {
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderObserver silent;
  const PassPlan plan = plan_passes(chosen.any(), 16, PointSetKind::blue_noise);
  const RenderResult r = render(chosen.any(), scene.settings(PointSetKind::blue_noise, plan, 3), silent);
  std::vector<double> all;
  const PixelBounds& b = r.film.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x)
      for (double channel : r.film.pixel(x, y).mean) all.push_back(channel);
  return all;
}

TEST(IntegratorSettings, change_the_picture) {
  const TestScene glossy{std::string_view(room)}, diffuse{std::string_view(diffuse_room())},
      foggy{std::string_view(foggy_room())}, under_sky{std::string_view(sky_room())};
  int tested = 0;
  for (const EntitySpec& spec : integrator_catalogue()) {
    std::map<std::string, std::vector<double>> before;  // by the scene and what is stated beside the setting
    for (const ParameterSpec& row : spec.parameters) {
      if (without_effect.contains(row.name)) continue;
      const bool is_of_sky = row.name.starts_with("sky-");
      const TestScene& scene = spec.name == "radiosity"      ? diffuse
                               : row.name == "medium-radius" ? foggy
                               : is_of_sky                   ? under_sky
                                                             : glossy;
      const std::string beside = companions(spec.name, row.name);
      const std::string way = std::string(spec.name) + (beside.empty() ? "" : ":" + beside);
      const std::string of_scene = is_of_sky ? "sky " + beside : beside;
      if (!before.contains(of_scene)) before[of_scene] = picture(scene, way);
      const std::vector<std::string> values = values_of(row);
      EXPECT_FALSE(values.empty()) << spec.name << " " << row.name;
      const bool changes = std::ranges::any_of(values, [&](const std::string& value) {
        return picture(scene, fmt::format("{}{}{}={}", way, beside.empty() ? ":" : ",", row.name, value)) !=
               before[of_scene];
      });
      EXPECT_TRUE(changes) << spec.name << ": " << row.name << " was set to "
                           << fmt::format("{}", fmt::join(values, ", "));
      ++tested;
    }
  }
  EXPECT_GT(tested, 90);
}

// The picture is a function of the settings, so that a difference is that of the setting; and what is said to change
// nothing changes nothing.
TEST(IntegratorSettings, alone_decide_the_picture_and_some_do_not) {
  const TestScene scene{std::string_view(room)};
  for (const char* way : {"path", "bdpt", "sppm", "restir-di"})
    EXPECT_EQ(picture(scene, way), picture(scene, way)) << way;
  EXPECT_EQ(picture(scene, "irradiance-cache"), picture(scene, "irradiance-cache:pairs=0.5"));
  EXPECT_EQ(picture(scene, "restir-di"), picture(scene, "restir-di:carry=off"));
}

}  // namespace
}  // namespace montelux::test
