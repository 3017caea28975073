// Scenes that state one parameter of the tables, with what it needs.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "api/render.h"
#include "io/checks.h"
#include "io/pbrt/parameters.h"
#include "measured_files.h"
#include "temporary_folder.h"

namespace montelux::test {

// Files that parameters name.
inline void write_files(const TemporaryFolder& folder) {
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
  folder.write("table.bsdf",
               measured_file({0.5, 0.5, {0.6, 0.4, 0.2}, {}}, {.elevations = 3, .facets = 5, .values = 4}));
}

// The values of parameters that not just any value is right for, by their names; after a colon: of one entity.
inline const std::map<std::string, std::string, std::less<>>& values() {
  static const std::map<std::string, std::string, std::less<>> all{
      {"filename", "\"image.pfm\""},
      {"plymesh:filename", "\"mesh.ply\""},
      {"plymesh:filename1", "\"mesh.ply\""},
      {"measured:filename", "\"table.bsdf\""},
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
inline const std::map<std::string, std::string, std::less<>>& companions() {
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
inline std::vector<std::string> needs(Family family, const std::string& type) {
  if (family == Family::texture && type == "imagemap") return {"\"string filename\" \"image.pfm\""};
  if (family == Family::light && type == "projection") return {"\"string filename\" \"image.pfm\""};
  if (family == Family::material && type == "mix") return {"\"string materials\" [ \"a\" \"b\" ]"};
  if (family == Family::material && type == "measured") return {"\"string filename\" \"table.bsdf\""};
  if (family != Family::shape) return {};
  if (type == "plymesh") return {"\"string filename\" \"mesh.ply\""};
  if (type == "trianglemesh") return {"\"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]"};
  if (type == "loopsubdiv") return {"\"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]", "\"integer indices\" [ 0 1 2 ]"};
  if (type == "bilinearmesh") return {"\"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]"};
  if (type == "curve") return {"\"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 1 0 ]"};
  return {};
}

template <class Map>
inline std::string of(const Map& map, const std::string& entity, std::string_view parameter) {
  auto own = map.find(entity + ":" + std::string(parameter));
  if (own == map.end()) own = map.find(parameter);
  return own == map.end() ? "" : own->second;
}

// The texture of a kind that the parameter takes; where it takes both, of the kind of the texture that it belongs to.
inline std::string texture_for(const ParameterSpec& spec, bool spectra) {
  const auto takes = [&](ParameterType type) { return std::ranges::find(spec.types, type) != spec.types.end(); };
  const bool is_spectrum = takes(ParameterType::spectrum) && (spectra || !takes(ParameterType::number));
  return is_spectrum ? "\"colours\"" : "\"numbers\"";
}

inline std::string value_of(const std::string& entity, const ParameterSpec& spec, ParameterType type, bool spectra) {
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

inline std::string type_text(ParameterType type) {
  return type == ParameterType::spectrum ? "rgb" : std::string(pbrt::spelling(type));
}

// The entity with one of its parameters, which begins the third line; without it for an empty value.
inline std::string entity_text(Family family, const EntitySpec& entity, const ParameterSpec& spec,
                               const std::string& word, const std::string& value) {
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
inline std::string scene_text(Family family, const EntitySpec& entity, const std::string& parameters, bool spectra) {
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

inline std::vector<float> picture_of(const TemporaryFolder& folder, const std::string& text) {
  LoadOptions options;
  options.resolution = {6, 4};
  const LoadResult loaded = load_scene(folder.write("scene.pbrt", text), options);
  if (!loaded.scene) return {};
  RenderObserver observer;
  RenderOptions how;
  how.samples = 2, how.threads = 1, how.shared_filters = false;  // samples all over these few pixels
  const Result<Rendering> rendering = render_scene(*loaded.scene, how, observer);
  EXPECT_TRUE(rendering) << text;
  return rendering ? layers_of(*rendering).values : std::vector<float>{};
}

}  // namespace montelux::test
