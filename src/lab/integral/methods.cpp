#include "lab/integral/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace montelux::lab {
namespace {

using enum ParameterType;

constexpr std::array<std::string_view, 2> strata_names{"grid", "latin"};

// The samplers that have points for integrals.
std::vector<std::string_view> points_names() {
  std::vector<std::string_view> names;
  for (const NamedPointSet& entry : point_set_names)
    if (cube_fill(entry.kind)) names.push_back(entry.name);
  return names;
}

// "max" is the short name of the heuristic that mc calls maximum.
std::vector<std::string_view> heuristic_names() {
  std::vector<std::string_view> names;
  for (const NamedMisHeuristic& entry : mis_heuristic_names) names.push_back(entry.name);
  names.push_back("max");
  return names;
}

std::vector<ParameterSpec> with_passes(std::vector<ParameterSpec> list = {}) {
  list.push_back({"passes",
                  {integer},
                  "independent randomisations that give the error bar; default depends on the method",
                  2,
                  1e6});
  return list;
}

std::vector<EntitySpec> make_table() {
  return {
      {"uniform", "independent uniform points", with_passes()},
      {"stratified", "one point in each stratum of the cube",
       with_passes({{"strata",
                     {string},
                     "grid of boxes, or Latin hypercube; default grid",
                     -1e30,
                     1e30,
                     {strata_names.begin(), strata_names.end()}}})},
      {"antithetic", "each point with its mirror image in the centre of the cube", with_passes()},
      {"control", "uniform points, with a control variate whose integral is known",
       with_passes({{"coefficient",
                     {number},
                     "coefficient of the control variate; default the best, fitted on the other passes"}})},
      {"importance", "points of a given density", with_passes()},
      {"mis", "points of several densities, weighted by a heuristic",
       with_passes({{"heuristic", {string}, "default balance", -1e30, 1e30, heuristic_names()}})},
      {"qmc", "randomised quasi-Monte Carlo",
       with_passes({{"points",
                     {string},
                     "randomised points, like those of the sampler with the same name; default sobol",
                     -1e30,
                     1e30,
                     points_names()},
                    {"baker", {boolean}, "fold each coordinate, which makes the integrand periodic; default false"},
                    {"adapt", {boolean}, "through an adaptive map of each coordinate; default false"}})},
      {"vegas", "adaptive map of each coordinate and adaptive stratification (Lepage 2021)", with_passes()},
      {"miser", "recursive stratification (Press and Farrar 1990)", with_passes()},
      {"ris", "importance resampling by a target that need not be normalised",
       with_passes({{"candidates", {integer}, "candidates M of each estimate; default 16", 1, 1e6},
                    {"resamples", {integer}, "resampled points N of each estimate; default 1", 1, 1e6}})},
      {"metropolis", "Markov chains for a target that need not be normalised, started by resampling (Veach 1997)",
       with_passes({{"step", {number}, "size of a small step; default 0.3", 1e-6, 1}})},
      {"auto", "the method of the best measured efficiency", {}},
  };
}

// The value of a choice by its index among the names; absent if it is none of them.
template <std::size_t N>
std::optional<std::size_t> place_of(const std::array<std::string_view, N>& names, std::string_view name) {
  for (std::size_t i = 0; i < N; ++i)
    if (names[i] == name) return i;
  return std::nullopt;
}

// Sets the one field that the parameter names; the value has been checked.
void assign(Method& method, const Parameter& p, const ParameterList& list) {
  if (p.name == "passes") method.passes = std::uint32_t(list.integer(p.name, 0));
  if (p.name == "strata") method.strata = Strata(*place_of(strata_names, list.string(p.name, "grid")));
  if (p.name == "points") method.points = *point_set_named(list.string(p.name, "sobol"));
  if (p.name == "coefficient") method.coefficient = double(list.number(p.name, 1));
  if (p.name == "baker") method.baker = list.boolean(p.name, false);
  if (p.name == "adapt") method.adapt = list.boolean(p.name, false);
  if (p.name == "candidates") method.candidates = std::uint32_t(list.integer(p.name, 16));
  if (p.name == "resamples") method.resamples = std::uint32_t(list.integer(p.name, 1));
  if (p.name == "step") method.step = double(list.number(p.name, 0.3f));
  if (p.name == "heuristic") {
    const std::string name = list.string(p.name, "balance");
    method.heuristic = name == "max" ? MisHeuristic::maximum : *mis_heuristic_named(name);
  }
}

}  // namespace

std::span<const EntitySpec> method_table() {
  static const std::vector<EntitySpec> table = make_table();
  return table;
}

std::string_view name_of(MethodKind kind) { return method_table()[std::size_t(kind)].name; }

Result<Method> method_of(std::string_view name, const std::vector<Setting>& settings) {
  const EntitySpec* spec = find_entity(method_table(), name);
  if (spec == nullptr) return unknown_name("method", name, names_of(method_table()));
  const Result<ParameterList> list = read_settings(*spec, settings, "method");
  if (!list) return list.failure();
  Method method;
  method.kind = MethodKind(spec - method_table().data());
  for (const Parameter& p : list->all()) assign(method, p, *list);
  return method;
}

Result<Method> parse_method(std::string_view text) {
  const Result<ChoiceText> choice = parse_choice(text);
  if (!choice) return choice.failure();
  return method_of(choice->name, choice->settings);
}

std::string to_text(const Method& method) {
  const Method plain;
  std::vector<std::string> items;
  const auto has = [&](std::string_view name) {
    return find_parameter(method_table()[std::size_t(method.kind)], name) != nullptr;
  };
  const auto add = [&](std::string_view name, bool differs, auto value) {
    if (differs && has(name)) items.push_back(fmt::format("{}={}", name, value));
  };
  add("strata", method.strata != plain.strata, strata_names[std::size_t(method.strata)]);
  add("coefficient", method.coefficient.has_value(), float(method.coefficient.value_or(0)));
  add("heuristic", method.heuristic != plain.heuristic, mis_heuristic_names[std::size_t(method.heuristic)].name);
  add("points", method.points != plain.points, name_of(method.points));
  add("baker", method.baker, "true");
  add("adapt", method.adapt, "true");
  add("candidates", method.candidates != plain.candidates, method.candidates);
  add("resamples", method.resamples != plain.resamples, method.resamples);
  add("step", float(method.step) != float(plain.step), float(method.step));
  add("passes", method.passes != 0, method.passes);
  if (items.empty()) return std::string(name_of(method.kind));
  return fmt::format("{}:{}", name_of(method.kind), fmt::join(items, ","));
}

}  // namespace montelux::lab
