#include "integrator/path/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "image/features.h"

namespace montelux {

namespace {

using enum ParameterType;

// "throughput", "proportional", "efficiency", "fixed:0.5", "off".
Status read_roulette(const std::string& text, PathSettings& settings) {
  constexpr std::string_view fixed = "fixed:";
  if (text == "throughput") {
    settings.roulette = PathRoulette::throughput;
  } else if (text == "proportional") {
    settings.roulette = PathRoulette::proportional;
  } else if (text == "efficiency") {
    settings.roulette = PathRoulette::efficiency;
  } else if (text == "off") {
    settings.roulette = PathRoulette::off;
  } else if (text.starts_with(fixed)) {
    settings.roulette = PathRoulette::fixed;
    const char *at = text.data() + fixed.size(), *end = text.data() + text.size();
    const auto [next, error] = std::from_chars(at, end, settings.fixed_survival);
    if (error != std::errc{} || next != end || !(settings.fixed_survival > 0 && settings.fixed_survival < 1))
      return Failure{fmt::format(
          "roulette fixed takes a survival probability between 0 and 1, such as fixed:0.5; found \"{}\"", text)};
  } else {
    return Failure{
        fmt::format("roulette takes throughput, proportional, efficiency, fixed:PROBABILITY or off; found \"{}\"{}",
                    text, did_you_mean(text, {"throughput", "proportional", "efficiency", "fixed:0.5", "off"}))};
  }
  return Done{};
}

// "uniform", "power", "bvh", "learned", or "ris:32".
Status read_light_selection(const std::string& text, PathSettings& settings) {
  constexpr std::string_view resampled = "ris:";
  if (const auto at = std::ranges::find(light_selection_names, text); at != light_selection_names.end()) {
    settings.light_selection = LightSelection(at - light_selection_names.begin());
    return Done{};
  }
  if (text == "learned") {
    settings.light_selection = LightSelection::bvh, settings.learned_selection = true;
    return Done{};
  }
  if (text.starts_with(resampled)) {
    const char *at = text.data() + resampled.size(), *end = text.data() + text.size();
    const auto [next, error] = std::from_chars(at, end, settings.candidates);
    if (error != std::errc{} || next != end || settings.candidates < 1 || settings.candidates > 4096)
      return Failure{fmt::format(
          "light-selection ris takes a number of candidates from 1 to 4096, such as ris:32; found \"{}\"", text)};
    if (!settings.nee) return Failure{"light-selection=ris chooses lights for next-event estimation: nee must be on"};
    settings.light_selection = LightSelection::bvh;
    return Done{};
  }
  return Failure{fmt::format("light-selection takes uniform, power, bvh, learned or ris:CANDIDATES; found \"{}\"{}",
                             text, did_you_mean(text, {"uniform", "power", "bvh", "learned", "ris:8"}))};
}

std::string roulette_text(const PathSettings& s) {
  switch (s.roulette) {
    case PathRoulette::throughput:
      return "throughput";
    case PathRoulette::proportional:
      return "proportional";
    case PathRoulette::efficiency:
      return "efficiency";
    case PathRoulette::fixed:
      return "fixed:" + setting_text(s.fixed_survival);
    case PathRoulette::off:
      break;
  }
  return "off";
}

// What `naive` takes, too.
Fields<PathSettings> common_fields() {
  Fields<PathSettings> fields;
  fields.other(max_depth_spec())
      .text("roulette", "throughput, proportional, efficiency, fixed:PROBABILITY or off", read_roulette, roulette_text)
      .integer("roulette-depth", &PathSettings::roulette_depth, "scattering events before roulette", 0, 1 << 20)
      .integer("lamp-rays", &PathSettings::lamp_rays, lamp_rays_meaning, 0, max_lamp_rays)
      .choice<Lanes>("lanes", &PathSettings::lanes, "number of paths traced together", lanes_names());
  return fields;
}

Fields<PathSettings> light_fields() {
  Fields<PathSettings> fields;
  fields.boolean("nee", &PathSettings::nee, "next-event estimation")
      .choice<PathMis>(
          "mis", &PathSettings::mis,
          "how the two techniques are combined; auto: by the balance heuristic for light from infinity if an "
          "image of the sky is there, else by power",
          {{"auto", PathMis::automatic},
           {"balance", PathMis::balance},
           {"power", PathMis::power},
           {"off", PathMis::off}})
      .text("light-selection",
            "how lights are chosen: uniform, power, bvh, learned (bvh with what is learned before the render of which "
            "lights are hidden), or ris:CANDIDATES (one of that many by bvh, by what each would contribute); default: "
            "as stated by the scene",
            read_light_selection)
      .integer("light-paths", &PathSettings::light_paths, "paths from which light-selection=learned learns", 1024,
               1 << 30)
      .choice<int>("manifold", &PathSettings::manifold,
                   "manifold next-event estimation: maximum number of specular events between a rough surface and a "
                   "point, spot, goniometric, projection or distant light",
                   {{"1", 1}, {"2", 2}, {"3", 3}, {"4", 4}, {"off", 0}})
      .number("manifold-roughness", &PathSettings::manifold_roughness,
              "largest GGX alpha of surfaces that manifold treats like smooth ones; 0: smooth surfaces only", 0, 1)
      .boolean("guiding", &PathSettings::guiding,
               "path guiding: also sample directions from a distribution that is learned before the render")
      .integer("guiding-paths", &PathSettings::guiding_paths, "paths from which guiding learns", 1024, 1 << 30)
      .boolean("sky-learning", &PathSettings::sky_learning,
               "learn before the render from which directions the brightest light from infinity is visible, and "
               "sample it there")
      .integer("sky-paths", &PathSettings::sky_paths, "paths from which sky-learning learns", 1024, 1 << 30);
  return fields;
}

}  // namespace

NamedValues<Lanes> lanes_names() { return {{"one", Lanes::one}, {"native", Lanes::native}}; }

ParameterSpec max_depth_spec() {
  return {"maxdepth", {integer},  "maximum number of bounces; default: as stated by the scene, else none",
          0,          2147483647, {"none"}};
}

EntitySpec path_spec() {
  EntitySpec spec{"path", "path tracing: next-event estimation and BSDF sampling by MIS, Russian roulette",
                  light_fields().specs({})};
  for (ParameterSpec& more : common_fields().specs({})) spec.parameters.push_back(std::move(more));
  return spec;
}

EntitySpec naive_spec() {
  return {"naive", "path tracing that finds light only when a path hits an emitter", common_fields().specs({})};
}

Result<PathSettings> path_settings(const ParameterList& list, std::optional<int> max_depth) {
  PathSettings s;
  s.max_depth = max_depth;
  for (const Fields<PathSettings>& fields : {light_fields(), common_fields()})
    if (Status read = fields.read(list, s); !read) return read.failure();
  if (!s.guiding && list.find("guiding-paths")) return Failure{"guiding-paths is for path guiding: guiding must be on"};
  if (!s.sky_learning && list.find("sky-paths")) return Failure{"sky-paths is for sky-learning, which must be on"};
  if (!s.learned_selection && list.find("light-paths")) return Failure{"light-paths is for light-selection=learned"};
  if (s.sky_learning && !s.nee) return Failure{"sky-learning is for next-event estimation: nee must be on"};
  if (s.manifold == 0 && list.find("manifold-roughness"))
    return Failure{"manifold-roughness is for manifold next-event estimation: manifold must be on"};
  if (s.roulette == PathRoulette::off && !s.max_depth)
    return Failure{"without roulette paths may never end: maxdepth must also be set"};
  return s;
}

}  // namespace montelux
