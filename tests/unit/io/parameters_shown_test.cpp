// Every parameter of what a scene shows, and of how its picture is made, changes the picture. Those of what it shows
// are written and read again.
#include <gtest/gtest.h>

#include <set>

#include "io/pbrt.h"
#include "io/write_pbrt.h"
#include "parameter_scenes.h"

namespace montelux::test {

namespace {

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
      {"dots:uvmatrix", "\"float uscale\" 6 \"float vscale\" 6"},
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

INSTANTIATE_TEST_SUITE_P(OfTheTables, ShownParameters,
                         testing::Values(Family::material, Family::texture, Family::light, Family::area_light,
                                         Family::shape, Family::medium, Family::filter),
                         [](const auto& family) {
                           std::string name(name_of(family.param));
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

// ---- how a picture is made

// As shown_with() and other_values(), for the families of the picture.
const std::map<std::string, std::string, std::less<>>& made_with() {
  static const std::map<std::string, std::string, std::less<>> all{
      {"focaldistance", "\"float lensradius\" 0.3"},
      {"apertureblades", "\"float focaldistance\" 1"},
      {"aperturerotation", "\"float focaldistance\" 1"},
  };
  return all;
}
const std::map<std::string, std::string, std::less<>>& values_of_pictures() {
  static const std::map<std::string, std::string, std::less<>> all{
      {"xresolution", "5"},
      {"yresolution", "6"},
      {"maxdepth", "1"},
      {"lightsampler", "\"uniform\""},
      {"fov", "50"},
      {"frameaspectratio", "1.4"},
      {"apertureblades", "3"},
      {"spherical:mapping", "\"equirectangular\""},
      {"samplelights", "false"},
      {"cossample", "false"},
      {"jitter", "false"},
      {"photonsperiteration", "7"},
      {"largestepprobability", "0.9"},
      {"cropwindow", "[ 0.25 1 0 0.75 ]"},
      {"screenwindow", "[ -0.7 0.5 -0.9 1 ]"},
  };
  return all;
}
// What the picture does not show, with the reason.
const std::set<std::string, std::less<>>& unseen_in_pictures() {
  static const std::set<std::string, std::less<>> all{
      // Where the picture is written; Film.states_the_picture_to_write holds it.
      "rgb:filename", "gbuffer:filename", "spectral:filename",
      // Error bars need Owen's scrambling: a warning names what is replaced.
      "halton:randomization", "sobol:randomization", "paddedsobol:randomization", "zsobol:randomization"};
  return all;
}

// The picture of a ball on a floor, in the light of two lamps and a sky, as the file states it to be made. It is higher
// than wide, so that the axis of a camera shows; with these samples a few paths from the lights bounce into view.
std::vector<float> picture_as_stated(const TemporaryFolder& folder, Family family, const EntitySpec& entity,
                                     const std::string& parameters) {
  const std::string name = "\"" + std::string(entity.name) + "\"";
  const auto stated = [&](Family own, const std::string& before, const std::string& otherwise) {
    return family == own ? before + parameters : otherwise;
  };
  // Unlike the others, an option without a parameter is none.
  const bool states_option = family == Family::option && parameters.find('"') != parameters.npos;
  const bool has_width = parameters.find("xresolution") != parameters.npos;
  const bool has_height = parameters.find("yresolution") != parameters.npos;
  std::string text = stated(Family::film, "Film " + name, "Film \"rgb\"");
  if (!has_width) text += " \"integer xresolution\" 6";
  if (!has_height) text += " \"integer yresolution\" 8";
  text += "\n" + stated(Family::camera, "Camera " + name, "Camera \"perspective\" \"float fov\" 42") + "\n" +
          stated(Family::sampler, "Sampler " + name, "Sampler \"zsobol\" \"integer pixelsamples\" 64") + "\n" +
          stated(Family::integrator, "Integrator " + name, "") + "\n" + (states_option ? "Option" + parameters : "") +
          "\n";
  text +=
      "WorldBegin LightSource \"point\" \"point3 from\" [ 2 2 1 ] \"rgb I\" [ 9 8 7 ]\n"
      "LightSource \"point\" \"point3 from\" [ -1 3 2 ] \"rgb I\" [ 0.3 0.8 0.5 ]\n"
      "LightSource \"infinite\" \"string filename\" \"image.pfm\"\n"
      "AttributeBegin Translate 0 -0.8 3 Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 3 AttributeEnd\n"
      "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [ 0.2 0.5 0.8 ]\n"
      "ActiveTransform EndTime Translate 0.3 0 0 ActiveTransform All Translate 0.2 0 3\n"
      "Shape \"sphere\" \"float radius\" 0.7 AttributeEnd\n";
  const LoadResult loaded = load_scene(folder.write("scene.pbrt", text), {});
  if (!loaded.scene) return {};
  RenderObserver observer;
  RenderOptions how;
  how.threads = 1;
  const Result<Rendering> rendering = render_scene(*loaded.scene, how, observer);
  EXPECT_TRUE(rendering) << text;
  if (!rendering) return {};
  PixelBuffer shown = layers_of(*rendering);
  shown.values.push_back(float(shown.width));
  return shown.values;
}

// The planted fault: parameters that nothing uses, which the tables have for their warning, change no picture.
class ParametersOfPictures : public testing::TestWithParam<Family> {};

TEST_P(ParametersOfPictures, change_the_picture) {
  const Family family = GetParam();
  TemporaryFolder folder;
  write_files(folder);
  std::string found;
  int count = 0;
  for (const EntitySpec& entity : table_of(family)) {
    if (entity.later) continue;
    for (const ParameterSpec& spec : entity.parameters) {
      const std::string own(entity.name), name = own + ":" + std::string(spec.name);
      const ParameterType type = spec.types.front();
      const auto picture = [&](const std::string& value) {
        const std::string with = of(made_with(), own, spec.name);
        return picture_as_stated(folder, family, entity,
                                 entity_text(family, entity, spec, type_text(type), value) + with + "\n");
      };
      std::string other = of(values_of_pictures(), own, spec.name);
      if (other.empty()) other = value_of(own, spec, type, false);
      const std::vector<float> with = picture(other), without = picture("");
      EXPECT_FALSE(with.empty() || without.empty()) << name;
      const bool changes = with != without;
      if (spec.later) {
        EXPECT_FALSE(changes) << name;
        continue;
      }
      ++count;
      if (!changes && !unseen_in_pictures().contains(name)) found += name + "\n";
      EXPECT_FALSE(changes && unseen_in_pictures().contains(name)) << name << " is seen";
    }
  }
  EXPECT_EQ(found, "") << "of " << count;
  EXPECT_GE(count, 2);
}

INSTANTIATE_TEST_SUITE_P(OfTheTables, ParametersOfPictures,
                         testing::Values(Family::camera, Family::film, Family::sampler, Family::integrator,
                                         Family::option),
                         [](const auto& family) { return std::string(name_of(family.param)); });

}  // namespace

}  // namespace montelux::test
