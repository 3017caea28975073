#include "integrator/direct/settings.h"

namespace montelux {

namespace {

using enum ParameterType;

constexpr DirectPreset presets[] = {
    {"cs348b-1-fixed", "4 eye rays, 1 shadow ray to the light's centre", 4, "direct:strategy=light-area,pattern=fixed"},
    {"cs348b-1-random", "4 eye rays, 1 random shadow ray", 4, "direct:strategy=light-area,pattern=random"},
    {"cs348b-16-grid", "4 eye rays, 16 shadow rays on a grid", 4,
     "direct:strategy=light-area,shadow-rays=16,pattern=uniform-grid"},
    {"cs348b-16-stratified", "4 eye rays, 16 jittered shadow rays", 4,
     "direct:strategy=light-area,shadow-rays=16,pattern=stratified"},
    {"cs348b-64-grid", "4 eye rays, 64 shadow rays on a grid", 4,
     "direct:strategy=light-area,shadow-rays=64,pattern=uniform-grid"},
    {"cs348b-64-stratified", "4 eye rays, 64 jittered shadow rays", 4,
     "direct:strategy=light-area,shadow-rays=64,pattern=stratified"},
    {"cs348b-100-grid", "4 eye rays, 100 shadow rays on a grid", 4,
     "direct:strategy=light-area,shadow-rays=100,pattern=uniform-grid"},
    {"cs348b-100-stratified", "4 eye rays, 100 jittered shadow rays", 4,
     "direct:strategy=light-area,shadow-rays=100,pattern=stratified"},
    {"cs348b-100-directions", "4 eye rays, 100 directions uniform in projected solid angle", 4,
     "direct:strategy=cosine,shadow-rays=100,pattern=random"},
    {"cs348b-100-area", "4 eye rays, 100 random points of the light", 4,
     "direct:strategy=light-area,shadow-rays=100,pattern=random"},
    {"cs348b-4x16", "4 eye rays, 16 jittered shadow rays each: 64 shadow rays", 4,
     "direct:strategy=light-area,shadow-rays=16,pattern=stratified"},
    {"cs348b-64x1", "64 eye rays, 1 random shadow ray each: 64 shadow rays", 64,
     "direct:strategy=light-area,shadow-rays=1,pattern=random"},
};

constexpr std::pair<std::string_view, PointSetKind> patterns[] = {
    {"random", PointSetKind::independent},
    {"uniform-grid", PointSetKind::uniform_grid},
    {"stratified", PointSetKind::stratified},
    {"sobol", PointSetKind::padded_sobol},
};

NamedValues<DirectStrategy> strategy_names() {
  NamedValues<DirectStrategy> names;
  for (std::size_t i = 0; i < direct_strategy_names.size(); ++i)
    names.emplace_back(direct_strategy_names[i], DirectStrategy(i));
  return names;
}

NamedValues<MisHeuristic> heuristic_names() {
  NamedValues<MisHeuristic> names;
  for (const NamedMisHeuristic& entry : mis_heuristic_names) names.emplace_back(entry.name, entry.heuristic);
  return names;
}

Status read_pattern(const std::string& text, DirectSettings& s) {
  s.fixed = text == "fixed";
  if (s.fixed) s.pattern = PointSetKind::uniform_grid;
  for (const auto& [name, kind] : patterns)
    if (name == text) s.pattern = kind;
  return Done{};
}

Fields<DirectSettings> direct_fields() {
  using S = DirectSettings;
  Fields<S> fields;
  fields.choice<DirectStrategy>("strategy", &S::strategy, "how the light is found", strategy_names())
      .integer("shadow-rays", &S::shadow_rays, "shadow rays of each camera ray", 1, 4096)
      .text("pattern", "points of shadow rays; default: those of the sampler; fixed and uniform-grid are biased",
            read_pattern, {}, {"fixed", "random", "uniform-grid", "stratified", "sobol"})
      .integer("candidates", &S::candidates, "of ris, for each shadow ray", 1, 4096)
      .choice<MisHeuristic>("mis", &S::heuristic, "heuristic of mis", heuristic_names())
      .choice<Lanes>("lanes", &S::lanes, "number of paths traced together", lanes_names());
  return fields;
}

}  // namespace

std::span<const DirectPreset> direct_presets() { return presets; }

EntitySpec direct_spec() {
  return {"direct", "direct light at the first surface only, by a choice of strategies", direct_fields().specs({})};
}

DirectSettings direct_settings(const ParameterList& list) {
  DirectSettings s;
  // None of the rows can fail: their choices have been checked.
  (void)direct_fields().read(list, s);
  return s;
}

}  // namespace montelux
