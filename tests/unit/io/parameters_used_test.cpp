// Every parameter that the tables accept is used, or a warning at its place says that it is not.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "api/render.h"
#include "io/checks.h"
#include "io/pbrt.h"
#include "io/pbrt/parameters.h"
#include "io/pbrt/picture.h"
#include "io/read_model.h"
#include "io/write_pbrt.h"
#include "light/table.h"
#include "material/table.h"
#include "mc/point_set.h"
#include "scene/prepare.h"
#include "temporary_folder.h"

namespace montelux::test {

namespace {

// Files that parameters name.
void write_files(const TemporaryFolder& folder) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  folder.write("mesh.ply", header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  folder.write("moved.ply", header + "0 0 0.5\n1 0.2 0\n0 1.3 0\n3 0 1 2\n");
  std::string image = "PF\n4 4\n-1.0\n";
  for (int i = 0; i < 4 * 4 * 3; ++i) {
    const float value = 0.02f * float((i * 7) % 48);
    image.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  folder.write("image.pfm", image);
}

// The values of parameters that not just any value is right for, by their names; after a colon: of one entity.
const std::map<std::string, std::string, std::less<>>& values() {
  static const std::map<std::string, std::string, std::less<>> all{
      {"filename", "\"image.pfm\""},
      {"plymesh:filename", "\"mesh.ply\""},
      {"plymesh:filename1", "\"mesh.ply\""},
      {"normalmap", "\"image.pfm\""},
      {"emissionfilename", "\"image.pfm\""},
      {"lensfile", "\"image.pfm\""},
      {"rgb:filename", "\"picture.exr\""},
      {"gbuffer:filename", "\"picture.exr\""},
      {"spectral:filename", "\"picture.exr\""},
      {"encoding", "\"linear\""},
      {"materials", "[ \"a\" \"b\" ]"},
      {"normalscale", "[ 1 1 ]"},
      {"coatnormalscale", "[ 1 1 ]"},
      {"screenwindow", "[ -1 1 -1 1 ]"},
      {"cropwindow", "[ 0 1 0 1 ]"},
      {"pixelbounds", "[ 0 2 0 2 ]"},
      {"uvmatrix", "[ 1 0 0 0 1 0 ]"},
      {"portal", "[ 0 0 1 1 0 1 1 1 1 0 1 1 ]"},
      {"P", "[ 0 0 0 1 0 0 0 1 0 ]"},
      {"N", "[ 0 0 1 0 0 1 0 0 1 ]"},
      {"S", "[ 1 0 0 1 0 0 1 0 0 ]"},
      {"uv", "[ 0 0 1 0 0 1 ]"},
      {"indices", "[ 0 1 2 ]"},
      {"P1", "[ 0 0 1 1 0 1 0 1 1 ]"},
      {"N1", "[ 0 0 1 0 0 1 0 0 1 ]"},
      {"bilinearmesh:P", "[ 0 0 0 1 0 0 0 1 0 1 1 0 ]"},
      {"bilinearmesh:N", "[ 0 0 1 0 0 1 0 0 1 0 0 1 ]"},
      {"bilinearmesh:uv", "[ 0 0 1 0 0 1 1 1 ]"},
      {"bilinearmesh:indices", "[ 0 1 2 3 ]"},
      {"curve:P", "[ 0 0 0 1 0 0 2 0 0 3 1 0 ]"},
      {"curve:N", "[ 0 0 1 0 0 1 ]"},
      {"curve:degree", "3"},
      {"dimension", "2"},
      {"shutterclose", "0.5"},
      {"shutteropen", "0.25"},
      {"coneangle", "40"},
      {"conedeltaangle", "4"},
      {"apertureblades", "6"},
      {"zmin", "-0.5"},
      {"zmax", "0.5"},
      {"innerradius", "0.5"},
      {"sphere:radius", "2"},
      {"disk:radius", "2"},
      {"group", "\"key\""},
      {"xresolution", "4"},
      {"yresolution", "4"},
      {"maxdepth", "3"},
      {"levels", "1"},
  };
  return all;
}

// What accompanies a parameter that is meaningless alone; by its name, after a colon: of one entity.
const std::map<std::string, std::string, std::less<>>& companions() {
  static const std::map<std::string, std::string, std::less<>> all{
      {"v1", "\"string mapping\" \"planar\""},
      {"v2", "\"string mapping\" \"planar\""},
      {"apertureblades", "\"float lensradius\" 0.1"},
      {"aperturerotation", "\"float lensradius\" 0.1 \"integer apertureblades\" 6"},
      {"N1", "\"normal N\" [ 0 0 1 0 0 1 0 0 1 ] \"point3 P1\" [ 0 0 1 1 0 1 0 1 1 ]"},
      {"curve:N", "\"string type\" \"ribbon\""},
      {"infinite:mapping", "\"string filename\" \"image.pfm\""},
      {"localpower", "\"string filename\" \"image.pfm\""},
      {"diffuse:tint", "\"string filename\" \"image.pfm\""},
      {"Lescale", "\"rgb Le\" [ 1 2 3 ]"},
      {"filter", ""},
  };
  return all;
}

// What an entity needs, by family and name.
std::vector<std::string> needs(Family family, const std::string& type) {
  if (family == Family::texture && type == "imagemap") return {"\"string filename\" \"image.pfm\""};
  if (family == Family::light && type == "projection") return {"\"string filename\" \"image.pfm\""};
  if (family == Family::material && type == "mix") return {"\"string materials\" [ \"a\" \"b\" ]"};
  if (family != Family::shape) return {};
  if (type == "plymesh") return {"\"string filename\" \"mesh.ply\""};
  if (type == "trianglemesh") return {"\"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]"};
  if (type == "loopsubdiv") return {"\"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]", "\"integer indices\" [ 0 1 2 ]"};
  if (type == "bilinearmesh") return {"\"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]"};
  if (type == "curve") return {"\"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 1 0 ]"};
  return {};
}

template <class Map>
std::string of(const Map& map, const std::string& entity, std::string_view parameter) {
  auto own = map.find(entity + ":" + std::string(parameter));
  if (own == map.end()) own = map.find(parameter);
  return own == map.end() ? "" : own->second;
}

// The texture of a kind that the parameter takes; where it takes both, of the kind of the texture that it belongs to.
std::string texture_for(const ParameterSpec& spec, bool spectra) {
  const auto takes = [&](ParameterType type) { return std::ranges::find(spec.types, type) != spec.types.end(); };
  const bool is_spectrum = takes(ParameterType::spectrum) && (spectra || !takes(ParameterType::number));
  return is_spectrum ? "\"colours\"" : "\"numbers\"";
}

std::string value_of(const std::string& entity, const ParameterSpec& spec, ParameterType type, bool spectra) {
  if (std::string stated = of(values(), entity, spec.name); !stated.empty()) return stated;
  switch (type) {
    case ParameterType::boolean:
      return "true";
    case ParameterType::integer:
    case ParameterType::number: {
      const double x = std::clamp(type == ParameterType::integer ? 2.0 : 0.75, spec.low, spec.high);
      return std::to_string(x).substr(0, type == ParameterType::integer ? std::to_string(x).find('.') : 20);
    }
    case ParameterType::string:
      return "\"" + std::string(spec.choices.empty() ? "text" : spec.choices.back()) + "\"";
    case ParameterType::spectrum:
      return spec.low < 0.25 ? "[ 0.25 0.5 0.75 ]" : "[ 1.25 1.5 1.75 ]";
    case ParameterType::texture:
      return texture_for(spec, spectra);
    case ParameterType::point2:
    case ParameterType::vector2:
      return "[ 0.5 1 ]";
    default:
      return "[ 0.5 0.25 1 ]";
  }
}

std::string type_text(ParameterType type) {
  return type == ParameterType::spectrum ? "rgb" : std::string(pbrt::spelling(type));
}

// The entity with one of its parameters, which begins the third line; without it for an empty value.
std::string entity_text(Family family, const EntitySpec& entity, const ParameterSpec& spec, const std::string& word,
                        const std::string& value) {
  const std::string name(entity.name);
  const std::string own = "\"" + word + " " + std::string(spec.name) + "\"";
  std::string rest;
  for (const std::string& needed : needs(family, name))
    if (!needed.starts_with(own)) rest += " " + needed;
  return "\n" + (value.empty() ? std::string() : own + " " + value) + "\n" + rest + " " +
         of(companions(), name, spec.name) + "\n";
  of(companions(), name, spec.name) + "\n";
}

// A scene that states the parameter on its third line.
std::string scene_text(Family family, const EntitySpec& entity, const std::string& parameters, bool spectra) {
  const std::string name = "\"" + std::string(entity.name) + "\"";
  const std::string parts =
      "Texture \"numbers\" \"float\" \"constant\" Texture \"colours\" \"spectrum\" \"constant\" "
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"b\" \"string type\" \"diffuse\"\n";
  const std::string ball = " Shape \"sphere\" LightSource \"point\"\n", end = "Material \"diffuse\"" + ball;
  switch (family) {
    case Family::camera:
      return "\nCamera " + name + parameters + "WorldBegin\n" + end;
    case Family::filter:
      return "\nPixelFilter " + name + parameters + "WorldBegin\n" + end;
    case Family::film:
      return "\nFilm " + name + parameters + "WorldBegin\n" + end;
    case Family::sampler:
      return "\nSampler " + name + parameters + "WorldBegin\n" + end;
    case Family::integrator:
      return "\nIntegrator " + name + parameters + "WorldBegin\n" + end;
    case Family::accelerator:
      return "\nAccelerator " + name + parameters + "WorldBegin\n" + end;
    case Family::option:
      return "\nOption" + parameters + "WorldBegin\n" + end;
    case Family::medium:
      return "\nMakeNamedMedium \"m\" \"string type\" " + name + parameters +
             "WorldBegin\nMediumInterface \"m\" \"\"\n" + end;
    case Family::texture:
      return "WorldBegin " + parts + "Texture \"t\" " + (spectra ? "\"spectrum\" " : "\"float\" ") + name + parameters +
             (spectra ? "Material \"diffuse\" \"texture reflectance\" \"t\""
                      : "Material \"coateddiffuse\" \"texture roughness\" \"t\"") +
             ball;
    case Family::light:
      return "WorldBegin " + parts + "LightSource " + name + parameters + end;
    case Family::area_light:
      return "WorldBegin " + parts + "AreaLightSource " + name + parameters + "ReverseOrientation " + end;
    case Family::shape:
      return "WorldBegin " + parts + "Shape " + name + parameters + end;
    case Family::material:
      return "WorldBegin " + parts + "Material " + name + parameters + "Shape \"sphere\" LightSource \"point\"\n";
  }
  return {};
}

// What was said of the third line.
struct Said {
  bool ready = false, no_effect = false, of_no_effect_elsewhere = false;
  std::string all;
};

Said say(const std::string& text, const std::string& folder) {
  ReadResult read = read_pbrt_text(text, folder);
  Said said;
  if (read.scene) said.ready = prepare(*read.scene, {}, read.diagnostics).has_value();
  for (const Diagnostic& d : read.diagnostics.all()) {
    said.all += std::to_string(d.where.line) + ":" + std::to_string(d.where.column) + " " + d.message + "\n";
    const bool no_effect = d.message.find("has no effect") != std::string::npos;
    const bool here = d.where.line == 3 && d.where.column == 1;
    said.no_effect |= no_effect && here, said.of_no_effect_elsewhere |= no_effect && !here;
  }
  return said;
}

class Parameters : public testing::TestWithParam<Family> {};

TEST_P(Parameters, are_used_or_warned_of) {
  TemporaryFolder folder;
  write_files(folder);
  const Family family = GetParam();
  int count = 0;
  for (const EntitySpec& entity : table_of(family)) {
    if (entity.later) continue;  // refused as a whole
    for (const ParameterSpec& spec : entity.parameters)
      for (const ParameterType type : spec.types) {
        // Some textures are of numbers or of spectra alone.
        Said said;
        for (bool spectra : {false, true})
          if (!said.ready || said.no_effect)
            said = say(scene_text(family, entity,
                                  entity_text(family, entity, spec, type_text(type),
                                              value_of(std::string(entity.name), spec, type, spectra)),
                                  spectra),
                       folder.path());
        ++count;
        EXPECT_TRUE(said.ready) << entity.name << " " << spec.name << ":\n" << said.all;
        EXPECT_EQ(said.no_effect, spec.later) << entity.name << " " << spec.name << ":\n" << said.all;
        EXPECT_FALSE(said.of_no_effect_elsewhere) << entity.name << " " << spec.name << ":\n" << said.all;
      }
  }
  EXPECT_GE(count, 2);
}

// A default that the meaning of a row states, as a file states it: type and value. Nothing for "default none" and the
// like.
std::optional<std::pair<std::string, std::string>> stated_default(const ParameterSpec& spec, bool spectra) {
  static const std::regex pattern("default (\\S+?(?: [-0-9.]+)*)(?:$|[;,)]| \\()");
  std::smatch match;
  if (!std::regex_search(spec.meaning, match, pattern)) return std::nullopt;
  const std::string value = match[1];
  static const std::regex numbers("[-0-9.e]+( [-0-9.e]+)*");
  const bool is_numbers = std::regex_match(value, numbers);
  const auto takes = [&](ParameterType type) { return std::ranges::find(spec.types, type) != spec.types.end(); };
  const std::size_t count = std::size_t(std::ranges::count(value, ' ')) + 1;
  if (takes(ParameterType::boolean) && (value == "true" || value == "false")) return std::pair{"bool", value};
  if (takes(ParameterType::string) && std::ranges::find(spec.choices, value) != spec.choices.end())
    return std::pair{"string", "\"" + value + "\""};
  const bool is_spectrum = takes(ParameterType::spectrum) && (spectra || !takes(ParameterType::number));
  if (is_spectrum && value.starts_with("metal-")) return std::pair{"spectrum", "\"" + value + "\""};
  if (!is_numbers) return std::nullopt;
  if (is_spectrum) return std::pair{"rgb", "[ " + (count == 3 ? value : value + " " + value + " " + value) + " ]"};
  return std::pair{type_text(spec.types.front()), "[ " + value + " ]"};
}

std::vector<float> picture_of(const TemporaryFolder& folder, const std::string& text) {
  LoadOptions options;
  options.resolution = {6, 4};
  const LoadResult loaded = load_scene(folder.write("scene.pbrt", text), options);
  if (!loaded.scene) return {};
  RenderObserver observer;
  RenderOptions how;
  how.samples = 2, how.threads = 1;
  const Result<Rendering> rendering = render_scene(*loaded.scene, how, observer);
  EXPECT_TRUE(rendering) << text;
  return rendering ? layers_of(*rendering).values : std::vector<float>{};
}

TEST_P(Parameters, have_the_defaults_that_the_tables_state) {
  TemporaryFolder folder;
  write_files(folder);
  const Family family = GetParam();
  int tried = 0, seen = 0;
  for (const EntitySpec& entity : table_of(family)) {
    if (entity.later) continue;
    for (const ParameterSpec& spec : entity.parameters)
      for (bool spectra : {false, true}) {
        const auto stated = stated_default(spec, spectra);
        if (spec.later || !stated || (spectra && family != Family::texture)) continue;
        const auto picture = [&](const std::string& value) {
          return picture_of(
              folder, scene_text(family, entity, entity_text(family, entity, spec, stated->first, value), spectra));
        };
        const std::vector<float> without = picture("");
        if (without.empty()) continue;  // a texture of the other kind
        EXPECT_TRUE(picture(stated->second) == without) << entity.name << " " << spec.name << " " << stated->second;
        ++tried;
        // The twin: most other values make another picture, so that another default would be found.
        const bool has_own_type = stated->first == type_text(spec.types.front());
        if (has_own_type)
          seen += picture(value_of(std::string(entity.name), spec, spec.types.front(), spectra)) != without;
      }
  }
  if (family == Family::material || family == Family::texture || family == Family::light || family == Family::shape) {
    EXPECT_GE(tried, 15);
    EXPECT_GE(seen, tried / 3) << tried;
  }
}

// What accompanies a parameter that shows only then.
const std::map<std::string, std::string, std::less<>>& shown_with() {
  static const std::map<std::string, std::string, std::less<>> all{
      {"normalscale", "\"texture normaltexture\" \"colours\""},
      {"coatnormalscale", "\"texture coatnormaltexture\" \"colours\""},
      {"remaproughness", "\"float roughness\" 0.3"},
      {"coatedconductor:remaproughness", "\"float interface.roughness\" 0.3"},
      {"g", "\"rgb albedo\" [ 0.5 0.6 0.7 ]"},
      {"homogeneous:g", ""},
      {"nsamples", "\"rgb albedo\" [ 0.5 0.6 0.7 ]"},
      {"coatedconductor:maxdepth", "\"rgb albedo\" [ 0.5 0.6 0.7 ]"},
      {"dots:inside", "\"float uscale\" 6 \"float vscale\" 6"},
      {"dots:udelta", "\"float uscale\" 6 \"float vscale\" 6"},
      {"dots:vdelta", "\"float uscale\" 6 \"float vscale\" 6"},
      {"dots:uscale", "\"float vscale\" 6"},
      {"checkerboard:tex2", "\"float uscale\" 6 \"float vscale\" 6"},
      {"bilerp:uscale", "\"float v10\" 0.7"},
      {"bilerp:udelta", "\"float v10\" 0.7"},
      {"curve:degree", "\"string basis\" \"bspline\""},
      {"threshold:edge", "\"float tex\" 0.6"},
      {"specular", "\"float metallic\" 0"},
      {"specularcolor", "\"float metallic\" 0"},
      {"metallicroughness:eta", "\"float metallic\" 0"},
      {"coatedmetallicroughness:eta", "\"float metallic\" 0"},
      {"anisotropy", "\"float roughness\" 0.5"},
      {"anisotropyrotation", "\"float roughness\" 0.5 \"float anisotropy\" 0.8"},
      {"grainx", "\"float roughness\" 0.5 \"float anisotropy\" 0.8 \"float grainy\" 0.9"},
      {"grainy", "\"float roughness\" 0.5 \"float anisotropy\" 0.8"},
      {"grainmirrored", "\"float roughness\" 0.5 \"float anisotropy\" 0.8 \"float anisotropyrotation\" 30"},
  };
  return all;
}

// Values that differ from the default and show.
const std::map<std::string, std::string, std::less<>>& other_values() {
  static const std::map<std::string, std::string, std::less<>> all{
      {"normalscale", "[ 0.2 0.4 ]"},
      {"coatnormalscale", "[ 0.2 0.4 ]"},
      {"uvmatrix", "[ 0.3 0.7 0.1 0.9 0.2 0.4 ]"},
      {"remaproughness", "false"},
      {"dimension", "3"},
      {"threshold:tex", "0.3"},
      {"channel", "\"r\""},
      {"imagemap:filter", "\"point\""},
      {"imagemap:encoding", "\"sRGB\""},
      {"infinite:mapping", "\"latlong\""},
      {"homogeneous:preset", "\"Apple\""},
      {"plymesh:filename1", "\"moved.ply\""},
      {"bilinearmesh:uv", "[ 0 0 2 0 0 3 2 3 ]"},
      {"curve:degree", "2"},
      {"levels", "0"},
      {"metallicroughness:eta", "1.9"},
      {"coatedmetallicroughness:eta", "1.9"},
      {"grainx", "0.1"},
      {"uscale", "3.7"},
      {"vscale", "3.7"},
  };
  return all;
}

// What this scene does not show, with the reason; other tests hold it.
const std::set<std::string, std::less<>>& unseen() {
  static const std::set<std::string, std::less<>> all{
      // Layers.
      "point:group", "spot:group", "distant:group", "goniometric:group", "projection:group", "infinite:group",
      "diffuse:group",
      // Of images of 8 bits alone; this one has floats.
      "imagemap:encoding",
      // Which triangles are sampled: there are none.
      "diffuse:localpower",
      // The indices that are stated are the default ones, and the scheme is the only one.
      "trianglemesh:indices", "bilinearmesh:indices", "loopsubdiv:scheme"};
  return all;
}

// A scene in which parameters of what it shows can be seen: a ball before the camera, in the light of a lamp and a sky.
std::string visible_text(Family family, const EntitySpec& entity, const std::string& parameters, bool spectra) {
  const std::string name = "\"" + std::string(entity.name) + "\"";
  const std::string begin =
      "Camera \"perspective\" \"float fov\" 42 WorldBegin\n"
      "Texture \"numbers\" \"float\" \"constant\" \"float value\" 0.35\n"
      "Texture \"colours\" \"spectrum\" \"constant\" \"rgb value\" [ 0.6 0.7 0.9 ]\n"
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n"
      "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0.1 0.2 0.3 ]\n";
  const std::string lamps =
      "LightSource \"point\" \"point3 from\" [ 2 2 -2 ] \"rgb I\" [ 9 8 7 ]\n"
      "LightSource \"infinite\" \"string filename\" \"image.pfm\"\n"
      "Texture \"checks\" \"spectrum\" \"checkerboard\" \"float uscale\" 7 \"float vscale\" 5\n";
  const std::string place = "Translate 0.2 0.1 3 Rotate 50 1 1 0.3 ", ball = place + "Shape \"sphere\"\n";
  switch (family) {
    case Family::texture:
      return begin + lamps + "Texture \"t\" " + (spectra ? "\"spectrum\" " : "\"float\" ") + name + parameters +
             (spectra ? ""
                      : "Texture \"u\" \"spectrum\" \"scale\" \"rgb tex\" [ 0.9 0.8 0.7 ] \"texture scale\" \"t\" ") +
             "Material \"diffuse\" \"texture reflectance\" " + (spectra ? "\"t\" " : "\"u\" ") + ball;
    case Family::light:
      return begin + "Translate 0 0 0.5 LightSource " + name + parameters + "Translate 0 0 -0.5 " + ball;
    case Family::area_light:
      return begin + "AttributeBegin Translate 0 0 2 Rotate 160 1 0.2 0 AreaLightSource " + name + parameters +
             "Shape \"disk\" \"float radius\" 0.4 AttributeEnd " + ball;
    case Family::shape:
      return begin + lamps + place +
             "Scale 1.4 1.4 1.4 Material \"metallicroughness\" \"texture basecolor\" \"checks\" Shape " + name +
             parameters;
    case Family::medium:
      return "MakeNamedMedium \"m\" \"string type\" " + name + parameters + begin + lamps +
             "MediumInterface \"m\" \"\" Material \"interface\" " + ball;
    case Family::material:
      return begin + lamps + "Material " + name + parameters + ball;
    default:
      return scene_text(family, entity, parameters, spectra);
  }
}

// The twin: a field that is read and that nothing uses.
class ShownParameters : public testing::TestWithParam<Family> {};

TEST_P(ShownParameters, change_the_picture) {
  const Family family = GetParam();
  TemporaryFolder folder;
  write_files(folder);
  std::string found;
  int count = 0;
  for (const EntitySpec& entity : table_of(family)) {
    if (entity.later) continue;
    for (const ParameterSpec& spec : entity.parameters) {
      if (spec.later) continue;
      bool changes = false;
      for (const ParameterType type : spec.types)
        for (bool spectra : {false, true}) {
          if (changes || (spectra && family != Family::texture)) continue;
          const auto picture = [&](const std::string& value) {
            std::string text = entity_text(family, entity, spec, type_text(type), value);
            text += of(shown_with(), std::string(entity.name), spec.name) + "\n";
            return picture_of(folder, visible_text(family, entity, text, spectra));
          };
          std::string other = of(other_values(), std::string(entity.name), spec.name);
          if (other.empty()) other = value_of(std::string(entity.name), spec, type, spectra);
          const std::vector<float> with = picture(other);
          const std::vector<float> without = picture("");
          // Without some parameters there is no picture.
          changes = !with.empty() && (without.empty() || with != without);
        }
      const std::string name = std::string(entity.name) + ":" + std::string(spec.name);
      ++count;
      if (!changes && !unseen().contains(name)) found += name + "\n";
    }
  }
  EXPECT_EQ(found, "") << "of " << count;
}

INSTANTIATE_TEST_SUITE_P(OfTheTables, Parameters,
                         testing::Values(Family::material, Family::texture, Family::light, Family::area_light,
                                         Family::shape, Family::camera, Family::filter, Family::film, Family::sampler,
                                         Family::integrator, Family::accelerator, Family::medium, Family::option),
                         [](const auto& family) {
                           std::string name(name_of(family.param));
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

// A parameter that differs from its default is in the text that is written, and is read from there.
TEST_P(ShownParameters, survive_writing) {
  TemporaryFolder folder;
  write_files(folder);
  const Family family = GetParam();
  std::string lost;
  int count = 0;
  for (const EntitySpec& entity : table_of(family)) {
    if (entity.later) continue;
    for (const ParameterSpec& spec : entity.parameters)
      for (const ParameterType type : spec.types) {
        if (spec.later || spec.choices.size() == 1) continue;  // nothing to write
        const std::string name = std::string(entity.name) + ":" + std::string(spec.name);
        const auto written = [&](const std::string& value, bool spectra) -> std::string {
          std::string text = entity_text(family, entity, spec, type_text(type), value);
          text += of(shown_with(), std::string(entity.name), spec.name) + "\n";
          const ReadResult read = read_pbrt_text(visible_text(family, entity, text, spectra), folder.path());
          return read.scene ? write_pbrt(*read.scene) : "";
        };
        std::string value = type == spec.types.front() ? of(other_values(), std::string(entity.name), spec.name) : "";
        if (value.empty()) value = value_of(std::string(entity.name), spec, type, false);
        std::string first;
        for (bool spectra : {false, true})
          if (first.empty())
            first = written(type == ParameterType::texture ? texture_for(spec, spectra) : value, spectra);
        const ReadResult again = read_pbrt_text(first, folder.path());
        ++count;
        // The width of a curve is written as that of both ends.
        const bool is_there = first.find(" " + std::string(spec.name) + "\"") != first.npos || name == "curve:width";
        if (!again.scene || write_pbrt(*again.scene) != first || !is_there) lost += name + "\n";
      }
  }
  EXPECT_EQ(lost, "") << "of " << count;
}

// The other families state how a picture is made, not what it shows.
INSTANTIATE_TEST_SUITE_P(OfTheTables, ShownParameters,
                         testing::Values(Family::material, Family::texture, Family::light, Family::area_light,
                                         Family::shape, Family::medium, Family::filter),
                         [](const auto& family) {
                           std::string name(name_of(family.param));
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

// The planted fault: a table takes a parameter that nothing reads.
TEST(Parameter, that_nothing_reads_is_told) {
  ReadResult read = read_pbrt_text("WorldBegin Shape \"sphere\" LightSource \"point\"", ".");
  ASSERT_TRUE(read.scene);
  const SourceLocation where{std::make_shared<const std::string>("room.pbrt"), 7, 9};
  const Parameter planted{"grain", ParameterType::number, std::vector<float>{1}, where};
  SceneDesc& scene = *read.scene;
  const auto expect_one = [](const Diagnostics& said, const std::string& owner) {
    ASSERT_EQ(said.all().size(), 1u) << owner;
    EXPECT_EQ(said.all()[0].where.line, 7);
    EXPECT_EQ(said.all()[0].where.column, 9);
    EXPECT_NE(said.all()[0].message.find("'grain' of " + owner), std::string::npos) << said.all()[0].message;
  };
  for (const EntitySpec& spec : material_models().specs()) {
    Diagnostics said;
    Reporter report(said, false);
    Entity stated{std::string(spec.name), {}, where};
    stated.parameters.add(planted);
    // Once, however many materials it is copied to.
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(read_model(material_models(), Family::material, stated, report));
    expect_one(said, "material '" + stated.type + "'");
  }
  {
    Diagnostics said;
    Reporter report(said, false);
    Entity lamp{"point", {}, where};
    lamp.parameters.add(planted);
    ASSERT_TRUE(read_model(light_models(), Family::light, lamp, report));
    expect_one(said, "light 'point'");
    // A default that several lights share is reported once.
    ASSERT_TRUE(read_model(light_models(), Family::light, Entity(lamp), report));
    expect_one(said, "light 'point'");
  }
  // The words of a file that are read into the description.
  for (const char* owner : {"sampler 'zsobol'", "Option"}) {
    pbrt::StatedPicture picture;
    (owner == std::string("Option") ? picture.options : picture.sampler.parameters).add(planted);
    Diagnostics said;
    Reporter report(said, false);
    pbrt::describe_picture(picture, scene, report);
    expect_one(said, owner);
  }
}

// A parameter that has an effect only with another one.
TEST(Parameter, that_has_an_effect_only_in_a_case_is_told_in_the_others) {
  const auto warnings = [](const std::string& parameters) {
    const ReadResult read =
        read_pbrt_text("WorldBegin AreaLightSource \"diffuse\" " + parameters + " Shape \"sphere\"", ".");
    std::string all;
    for (const Diagnostic& d : read.diagnostics.all()) all += d.message + "\n";
    return all;
  };
  EXPECT_EQ(warnings("\"rgb tint\" [ 1 2 3 ]"), "'tint' of area light 'diffuse' has no effect here\n");
  EXPECT_EQ(warnings("\"rgb L\" [ 1 2 3 ]"), "");
}

// The picture's settings of a text before WorldBegin, and what was said.
struct Taken {
  PictureSettings picture;
  std::string said;
};
Taken taken(const std::string& options) {
  ReadResult read = read_pbrt_text(options + " WorldBegin Shape \"sphere\" LightSource \"point\"", ".");
  EXPECT_TRUE(read.scene);
  Diagnostics said;
  std::optional<PreparedScene> prepared = prepare(*read.scene, {}, said);
  EXPECT_TRUE(prepared);
  Taken t{prepared->picture, ""};
  Diagnostics all = read.diagnostics;
  for (const Diagnostic& d : said.all()) all.add(d);
  for (const Diagnostic& d : all.all())
    t.said += std::to_string(d.where.line) + ":" + std::to_string(d.where.column) + " " + d.message + "\n";
  return t;
}

TEST(Sampler, without_jitter_takes_the_centres_of_the_strata) {
  const auto strata = [](int x, int y, const char* jitter) {
    return taken("Sampler \"stratified\" \"integer xsamples\" " + std::to_string(x) + " \"integer ysamples\" " +
                 std::to_string(y) + "\n \"bool jitter\" " + jitter);
  };
  EXPECT_EQ(strata(4, 4, "true").picture.sampler, PointSetKind::stratified);
  for (const auto& [x, y] : {std::pair{4, 4}, {2, 3}}) {
    const Taken without = strata(x, y, "false");
    EXPECT_EQ(without.said, "");
    ASSERT_EQ(without.picture.sampler, PointSetKind::uniform_grid);
    // The points of a pixel are the centres of x columns and y rows.
    std::set<std::pair<int, int>> cells;
    for (int i = 0; i < x * y; ++i) {
      const Sampler<float> points({without.picture.sampler, 0, 0, std::uint32_t(x * y)}, 5, 6, std::uint32_t(i));
      const Vec2f u = points.get2(0u);
      const float column = u.x * float(x) - 0.5f, row = u.y * float(y) - 0.5f;
      EXPECT_NEAR(column, std::round(column), 1e-5f);
      EXPECT_NEAR(row, std::round(row), 1e-5f);
      cells.insert({int(std::round(column)), int(std::round(row))});
    }
    EXPECT_EQ(cells.size(), std::size_t(x * y));
  }
  EXPECT_EQ(
      strata(8, 2, "false").said,
      "2:2 8 x 2 strata without jitter: the 16 samples are at the centres of a grid with 4 columns instead of 8\n");
}

TEST(Sampler, that_would_leave_no_error_bar_is_warned_of) {
  for (const char* good : {"owen", "fastowen"})
    EXPECT_EQ(taken("Sampler \"halton\" \"string randomization\" \"" + std::string(good) + "\"").said, "");
  for (const char* other : {"none", "permutedigits"})
    EXPECT_EQ(taken("Sampler \"sobol\" \"string randomization\" \"" + std::string(other) + "\"")
                  .said.find("1:17 points are scrambled"),
              0u);
}

TEST(Seed, is_that_of_the_sampler_or_of_the_options) {
  EXPECT_EQ(taken("").picture.seed, 0u);
  EXPECT_EQ(taken("Option \"integer seed\" 5").picture.seed, 5u);
  EXPECT_EQ(taken("Option \"integer seed\" 5 Sampler \"halton\" \"integer seed\" 6").picture.seed, 6u);
}

TEST(SceneIntegrator, has_ours_with_its_own_settings) {
  EXPECT_EQ(taken("Integrator \"ao\"").picture.integrator, "ao");
  EXPECT_EQ(
      taken("Integrator \"ambientocclusion\" \"float maxdistance\" 2.5 \"bool cossample\" false").picture.integrator,
      "ao:distance=2.5,cossample=off");
  EXPECT_EQ(taken("Integrator \"volpath\"").picture.integrator, "path");
  EXPECT_EQ(taken("Integrator \"bdpt\"").picture.integrator, "bdpt");
  EXPECT_EQ(taken("Integrator \"sppm\"").picture.integrator, "sppm");
  EXPECT_EQ(taken("Integrator \"sppm\" \"integer photonsperiteration\" -1").picture.integrator, "sppm");
  const auto photons = taken(
      "Integrator \"sppm\" \"integer photonsperiteration\" 5000 \"float radius\" 0.25 "
      "\"integer maxdepth\" 7 \"integer seed\" 9");
  EXPECT_EQ(photons.said, "");
  EXPECT_EQ(photons.picture.integrator, "sppm:photons=5000,radius=0.25");
  EXPECT_EQ(photons.picture.max_depth, 7);
  EXPECT_EQ(photons.picture.seed, 9u);
  EXPECT_EQ(taken("Integrator \"simplepath\" \"bool samplelights\" false").picture.integrator, "naive");
  EXPECT_EQ(taken("Integrator \"simplepath\" \"bool samplelights\" true").picture.integrator, "path");
}

TEST(Film, states_the_picture_to_write) {
  EXPECT_EQ(taken("Film \"rgb\"").picture.file, "");
  EXPECT_EQ(taken("Film \"rgb\" \"string filename\" \"a/b.exr\"").picture.file, "a/b.exr");
}

}  // namespace

}  // namespace montelux::test
