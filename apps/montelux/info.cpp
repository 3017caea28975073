// montelux info: the contents of a scene, or what a picture states about itself.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/images.h"
#include "api/json_text.h"
#include "api/render.h"
#include "options.h"
#include "picture_info_output.h"
#include "progress.h"
#include "shortcomings.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
  std::string scene;
  LoadOptions load;
  bool json = false, quiet = false;
};

std::string bytes_text(std::size_t bytes) { return count_text(double(bytes), "B"); }

bool has_bounds(const SceneInfo& info) { return info.low[0] <= info.high[0]; }

Json to_json(const std::vector<NamedThing>& things) {
  Json list = Json::array();
  for (const NamedThing& thing : things) list.push_back({{"name", thing.name}, {"kind", thing.kind}});
  return list;
}

// The first entries of a list, and the number of further ones: "floor (diffuse), ball (conductor) and 12 more".
template <class List, class Text>
std::string first_of(const List& list, Text text) {
  constexpr std::size_t shown = 8;
  std::string line;
  for (std::size_t i = 0; i < std::min(list.size(), shown); ++i) line += (i > 0 ? ", " : "") + text(list[i]);
  if (list.size() > shown) line += fmt::format(" and {} more", list.size() - shown);
  return line;
}

std::string text_of(const NamedThing& thing) {
  return fmt::format("{} ({})", thing.name.empty() ? "-" : thing.name, thing.kind);
}

// Cameras and animations of a file with several.
void print_choices(const SceneInfo& info) {
  const auto name = [](const std::string& text) { return text.empty() ? std::string("-") : text; };
  if (!info.cameras.empty()) fmt::print("cameras   {}: {}\n", info.cameras.size(), first_of(info.cameras, name));
  if (!info.animations.empty())
    fmt::print("animated  {}: {}\n", info.animations.size(), first_of(info.animations, [&](const AnimationInfo& a) {
                 return fmt::format("{} ({})", name(a.name), time_text(a.seconds));
               }));
}

void print_json(const SceneInfo& info, const std::vector<std::string>& missing) {
  Json lights = Json::object();
  for (const auto& [kind, count] : info.lights) lights[kind] = count;
  Json json;
  json["scene"] = info.file;
  json["width"] = info.width, json["height"] = info.height;
  json["crop"] = {info.crop.x0, info.crop.y0, info.crop.x1, info.crop.y1};
  json["camera"] = info.camera, json["film"] = info.film, json["filter"] = info.filter;
  json["sampler"] = info.sampler, json["integrator"] = info.integrator;
  json["samples"] = info.samples;
  json["max_depth"] = info.max_depth ? Json(*info.max_depth) : Json();
  json["triangles"] = info.triangles, json["instanced_triangles"] = info.instanced_triangles;
  json["quadrics"] = info.quadrics, json["patches"] = info.patches, json["curve_segments"] = info.curve_segments;
  json["instances"] = info.instances, json["objects"] = info.objects;
  json["materials"] = info.materials, json["textures"] = info.textures;
  json["material_list"] = to_json(info.material_names), json["texture_list"] = to_json(info.texture_names);
  json["lights"] = lights;
  json["cameras"] = info.cameras;
  json["animations"] = Json::array();
  for (const AnimationInfo& a : info.animations)
    json["animations"].push_back({{"name", a.name}, {"seconds", a.seconds}});
  json["bounds"] = nullptr;  // of nothing
  if (has_bounds(info))
    json["bounds"] = {{info.low[0], info.low[1], info.low[2]}, {info.high[0], info.high[1], info.high[2]}};
  json["geometry_bytes"] = info.geometry_bytes, json["accel_bytes"] = info.accel_bytes;
  json["texture_bytes"] = info.texture_bytes;
  json["read_seconds"] = info.read_seconds, json["prepare_seconds"] = info.prepare_seconds;
  json["build_seconds"] = info.build_seconds;
  add_to(json, {missing, info.replaced, info.left_out});
  fmt::print("{}\n", json_text(std::move(json), 2));
}

void print_text(const SceneInfo& info, const std::vector<std::string>& missing) {
  fmt::print("scene     {}\n", info.file);
  fmt::print("picture   {} x {} pixels", info.width, info.height);
  if (info.crop != PixelBounds{0, 0, info.width, info.height})
    fmt::print(", of these {},{},{},{}", info.crop.x0, info.crop.y0, info.crop.x1, info.crop.y1);
  fmt::print("; {} samples per pixel\n", info.samples);
  fmt::print("by        camera {}, film {}, filter {}, sampler {}, integrator {}", info.camera, info.film, info.filter,
             info.sampler, info.integrator);
  if (info.max_depth) fmt::print(" up to {} scattering events", *info.max_depth);
  fmt::print("\nshapes    {} triangles", info.triangles);
  if (info.instances > 0)
    fmt::print(" ({} including instances: {} instances of {} objects)", info.instanced_triangles, info.instances,
               info.objects);
  fmt::print(", {} quadrics, {} patches, {} curve segments\n", info.quadrics, info.patches, info.curve_segments);
  print_choices(info);
  fmt::print("looks     {} materials, {} textures\n", info.materials, info.textures);
  if (!info.material_names.empty()) fmt::print("          {}\n", first_of(info.material_names, text_of));
  if (!info.texture_names.empty()) fmt::print("          {}\n", first_of(info.texture_names, text_of));
  fmt::print("lights   ");
  for (const auto& [kind, count] : info.lights) fmt::print(" {} {}", count, kind);
  if (info.lights.empty()) fmt::print(" none: the image will be black");
  if (has_bounds(info))
    fmt::print("\nbounds    {:.6g} {:.6g} {:.6g} to {:.6g} {:.6g} {:.6g}\n", info.low[0], info.low[1], info.low[2],
               info.high[0], info.high[1], info.high[2]);
  else
    fmt::print("\nbounds    none: there are no surfaces\n");
  fmt::print("memory    shapes {}, ray tracing {}, textures {}\n", bytes_text(info.geometry_bytes),
             bytes_text(info.accel_bytes), bytes_text(info.texture_bytes));
  fmt::print("time      read {}, prepare {}, build {}\n", time_text(info.read_seconds), time_text(info.prepare_seconds),
             time_text(info.build_seconds));
  print_text(Shortcomings{missing, info.replaced, info.left_out}, 10);
}

int run_picture_info(const InfoArguments& arguments) {
  const Result<PictureInfo> info = picture_info(arguments.scene);
  if (!info) return complain(info.error());
  if (arguments.json)
    print_picture_info_json(arguments.scene, *info);
  else
    print_picture_info(arguments.scene, *info);
  return done;
}

int run_info(const InfoArguments& arguments) {
  if (is_picture_name(arguments.scene)) return run_picture_info(arguments);
  LoadResult loaded = load_scene(arguments.scene, arguments.load);
  print_diagnostics(loaded.diagnostics, arguments.quiet);
  if (!loaded.scene) return bad_input;
  const std::vector<std::string> missing = missing_light_of(*loaded.scene);
  if (arguments.json)
    print_json(loaded.scene->info(), missing);
  else
    print_text(loaded.scene->info(), missing);
  return done;
}

}  // namespace

void add_info(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App& verb = *app.add_subcommand(
      "info", "Describe a scene (counts, sizes, lights, memory) or an image (layers, samples, error, bias)");
  verb.footer(
      "Examples:\n  montelux info room.pbrt\n  montelux info room.pbrt --json --lenient\n"
      "  montelux info room.exr                   how it was rendered, its error, and what biases it\n");
  add_scene_options(verb, arguments->scene, arguments->load);
  verb.add_flag("--json", arguments->json, "as one JSON object");
  verb.add_flag("--quiet", arguments->quiet, "no notes or warnings");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_info(*arguments); }; });
}

}  // namespace montelux::cli
