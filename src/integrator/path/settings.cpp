#include "integrator/path/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace montelux {

namespace {

using enum ParameterType;

// "throughput", "proportional", "fixed:0.5", "off".
Status read_roulette(const std::string& text, PathSettings& settings) {
  constexpr std::string_view fixed = "fixed:";
  if (text == "throughput") {
    settings.roulette = PathRoulette::throughput;
  } else if (text == "proportional") {
    settings.roulette = PathRoulette::proportional;
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
        fmt::format("roulette takes throughput, proportional, fixed:PROBABILITY or off; found \"{}\"", text)};
  }
  return Done{};
}

std::vector<ParameterSpec> common_parameters() {
  return {{"maxdepth", {integer}, "most bounces; default: as the scene asks, else none", 0, 2147483647, {"none"}},
          {"roulette", {string}, "throughput, proportional, fixed:PROBABILITY or off; default throughput"},
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
                    "how lights are chosen; default: as the scene says",
                    0,
                    0,
                    {light_selection_names.begin(), light_selection_names.end()}}}};
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
  if (const std::string selection = list.string("light-selection", ""); !selection.empty())
    s.light_selection =
        LightSelection(std::ranges::find(light_selection_names, selection) - light_selection_names.begin());
  s.lanes = list.string("lanes", "native") == "one" ? Lanes::one : Lanes::native;
  if (s.roulette == PathRoulette::off && !s.max_depth)
    return Failure{"without roulette paths may never end: maxdepth must be set, too"};
  return s;
}

}  // namespace montelux
