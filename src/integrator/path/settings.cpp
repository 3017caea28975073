#include "integrator/path/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

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
      return Failure{
          fmt::format("roulette fixed takes a survival probability between 0 and 1, as fixed:0.5; found \"{}\"", text)};
  } else {
    return Failure{
        fmt::format("roulette takes throughput, proportional, efficiency, fixed:PROBABILITY or off; found \"{}\"{}",
                    text, did_you_mean(text, {"throughput", "proportional", "efficiency", "fixed:0.5", "off"}))};
  }
  return Done{};
}

// "uniform", "power", "bvh", or "ris:32".
Status read_light_selection(const std::string& text, PathSettings& settings) {
  constexpr std::string_view resampled = "ris:";
  if (text.empty()) return Done{};
  if (const auto at = std::ranges::find(light_selection_names, text); at != light_selection_names.end()) {
    settings.light_selection = LightSelection(at - light_selection_names.begin());
    return Done{};
  }
  if (text.starts_with(resampled)) {
    const char *at = text.data() + resampled.size(), *end = text.data() + text.size();
    const auto [next, error] = std::from_chars(at, end, settings.candidates);
    if (error != std::errc{} || next != end || settings.candidates < 1 || settings.candidates > 4096)
      return Failure{fmt::format(
          "light-selection ris takes a number of candidates from 1 to 4096, as ris:32; found \"{}\"", text)};
    if (!settings.nee) return Failure{"light-selection=ris chooses lights for next-event estimation: nee must be on"};
    settings.light_selection = LightSelection::bvh;
    return Done{};
  }
  return Failure{fmt::format("light-selection takes uniform, power, bvh or ris:CANDIDATES; found \"{}\"{}", text,
                             did_you_mean(text, {"uniform", "power", "bvh", "ris:8"}))};
}

std::vector<ParameterSpec> common_parameters() {
  return {{"maxdepth",
           {integer},
           "maximum number of bounces; default: as the scene states, else none",
           0,
           2147483647,
           {"none"}},
          {"roulette", {string}, "throughput, proportional, efficiency, fixed:PROBABILITY or off; default throughput"},
          {"roulette-depth", {integer}, "scattering events before roulette; default 2", 0, 1 << 20},
          {"lanes", {string}, "paths side by side; default native", 0, 0, {"one", "native"}}};
}

}  // namespace

EntitySpec path_spec() {
  EntitySpec spec{"path",
                  "path tracing: next-event estimation and BSDF sampling by MIS, Russian roulette",
                  {{"nee", {boolean}, "next-event estimation; default on"},
                   {"mis", {string}, "how the two share the light; default power", 0, 0, {"balance", "power", "off"}},
                   {"light-selection",
                    {string},
                    "how lights are chosen: uniform, power, bvh, or ris:CANDIDATES (one out of so many of bvh, by what "
                    "each would contribute); default: as the scene says"}}};
  for (ParameterSpec& more : common_parameters()) spec.parameters.push_back(std::move(more));
  return spec;
}

EntitySpec naive_spec() {
  return {"naive", "path tracing that waits for the path to hit a light", common_parameters()};
}

Result<PathSettings> path_settings(const ParameterList& list, std::optional<int> max_depth) {
  PathSettings s;
  s.max_depth = max_depth;
  s.nee = list.boolean("nee", s.nee);
  const std::string mis = list.string("mis", "power");
  s.mis = mis == "off" ? PathMis::off : mis == "balance" ? PathMis::balance : PathMis::power;
  if (Status read = read_roulette(list.string("roulette", "throughput"), s); !read) return read.failure();
  s.roulette_depth = list.integer("roulette-depth", s.roulette_depth);
  if (Status read = read_light_selection(list.string("light-selection", ""), s); !read) return read.failure();
  s.lanes = list.string("lanes", "native") == "one" ? Lanes::one : Lanes::native;
  if (s.roulette == PathRoulette::off && !s.max_depth)
    return Failure{"without roulette paths may never end: maxdepth must be set, too"};
  return s;
}

}  // namespace montelux
