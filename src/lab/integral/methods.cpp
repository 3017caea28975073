#include "lab/integral/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "parameter/fields.h"

namespace montelux::lab {
namespace {

// The samplers that have points for integrals.
NamedValues<PointSetKind> point_names() {
  NamedValues<PointSetKind> names;
  for (const NamedPointSet& entry : point_set_names)
    if (cube_fill(entry.kind)) names.emplace_back(entry.name, entry.kind);
  return names;
}

// "max" is the short name of the heuristic that mc calls maximum.
NamedValues<MisHeuristic> heuristic_names() {
  NamedValues<MisHeuristic> names;
  for (const NamedMisHeuristic& entry : mis_heuristic_names) names.emplace_back(entry.name, entry.heuristic);
  names.emplace_back("max", MisHeuristic::maximum);
  return names;
}

// The parameters of a method.
Fields<Method> fields_of(MethodKind kind) {
  Fields<Method> fields;
  switch (kind) {
    case MethodKind::automatic:
      return fields;
    case MethodKind::stratified:
      fields.choice<Strata>("strata", &Method::strata, "grid of boxes, or Latin hypercube",
                            {{"grid", Strata::grid}, {"latin", Strata::latin}});
      break;
    case MethodKind::control:
      fields.optional("coefficient", &Method::coefficient,
                      "coefficient of the control variate; default the best, fitted on the other passes", -1e30, 1e30);
      break;
    case MethodKind::mis:
      fields.choice<MisHeuristic>("heuristic", &Method::heuristic, "", heuristic_names());
      break;
    case MethodKind::qmc:
      fields
          .choice<PointSetKind>("points", &Method::points,
                                "randomised points, like those of the sampler with the same name", point_names())
          .boolean("baker", &Method::baker, "fold each coordinate, which makes the integrand periodic")
          .boolean("adapt", &Method::adapt, "through an adaptive map of each coordinate");
      break;
    case MethodKind::ris:
      fields.integer("candidates", &Method::candidates, "candidates M of each estimate", 1, 1e6)
          .integer("resamples", &Method::resamples, "resampled points N of each estimate", 1, 1e6);
      break;
    case MethodKind::metropolis:
      fields.number("step", &Method::step, "size of a small step", 1e-6, 1);
      break;
    default:
      break;
  }
  return fields.optional("passes", &Method::passes,
                         "independent randomisations that give the error bar; default depends on the method", 2, 1e6);
}

// The value of a parameter of these types as a setting states it.
std::string value_text(const Parameter& p) {
  if (const auto* numbers = std::get_if<std::vector<float>>(&p.values)) return setting_text(numbers->front());
  if (const auto* integers = std::get_if<std::vector<int>>(&p.values)) return setting_text(integers->front());
  if (const auto* truths = std::get_if<std::vector<std::uint8_t>>(&p.values)) return setting_text(truths->front() != 0);
  return std::get<std::vector<std::string>>(p.values).front();
}

struct NamedMethod {
  MethodKind kind;
  std::string_view name, meaning;
};
constexpr NamedMethod named_methods[] = {
    {MethodKind::uniform, "uniform", "independent uniform points"},
    {MethodKind::stratified, "stratified", "one point in each stratum of the cube"},
    {MethodKind::antithetic, "antithetic", "each point with its mirror image in the centre of the cube"},
    {MethodKind::control, "control", "uniform points, with a control variate whose integral is known"},
    {MethodKind::importance, "importance", "points of a given density"},
    {MethodKind::mis, "mis", "points of several densities, weighted by a heuristic"},
    {MethodKind::qmc, "qmc", "randomised quasi-Monte Carlo"},
    {MethodKind::vegas, "vegas", "adaptive map of each coordinate and adaptive stratification (Lepage 2021)"},
    {MethodKind::miser, "miser", "recursive stratification (Press and Farrar 1990)"},
    {MethodKind::ris, "ris", "importance resampling by a target that need not be normalised"},
    {MethodKind::metropolis, "metropolis",
     "Markov chains for a target that need not be normalised, started by resampling (Veach 1997)"},
    {MethodKind::automatic, "auto", "the method of the best measured efficiency"},
};
static_assert(std::ranges::is_sorted(named_methods, {}, &NamedMethod::kind) &&
              std::size(named_methods) == std::size_t(MethodKind::automatic) + 1);

}  // namespace

std::span<const EntitySpec> method_table() {
  static const std::vector<EntitySpec> table = [] {
    std::vector<EntitySpec> rows;
    for (const NamedMethod& m : named_methods) rows.push_back({m.name, m.meaning, fields_of(m.kind).specs(Method{})});
    return rows;
  }();
  return table;
}

std::string_view name_of(MethodKind kind) { return named_methods[std::size_t(kind)].name; }

Result<Method> method_of(std::string_view name, const std::vector<Setting>& settings) {
  const EntitySpec* spec = find_entity(method_table(), name);
  if (spec == nullptr) return unknown_name("method", name, names_of(method_table()));
  const Result<ParameterList> list = read_settings(*spec, settings, "method");
  if (!list) return list.failure();
  Method method;
  method.kind = named_methods[spec - method_table().data()].kind;
  if (Status read = fields_of(method.kind).read(*list, method); !read) return read.failure();
  return method;
}

Result<Method> parse_method(std::string_view text) {
  const Result<ChoiceText> choice = parse_choice(text);
  if (!choice) return choice.failure();
  return method_of(choice->name, choice->settings);
}

std::string to_text(const Method& method) {
  std::vector<std::string> items;
  const ParameterList stated = fields_of(method.kind).write(method, Method{});
  for (const Parameter& p : stated.all()) items.push_back(fmt::format("{}={}", p.name, value_text(p)));
  if (items.empty()) return std::string(name_of(method.kind));
  return fmt::format("{}:{}", name_of(method.kind), fmt::join(items, ","));
}

}  // namespace montelux::lab
