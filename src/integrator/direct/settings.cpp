#include "integrator/direct/settings.h"

#include <algorithm>

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

}  // namespace

std::span<const DirectPreset> direct_presets() { return presets; }

EntitySpec direct_spec() {
  return {"direct",
          "direct light at the first surface alone, by the strategy of choice",
          {{"strategy",
            {string},
            "how the light is found; default mis",
            0,
            0,
            {direct_strategy_names.begin(), direct_strategy_names.end()}},
           {"shadow-rays", {integer}, "shadow rays of each camera ray; default 1", 1, 4096},
           {"pattern",
            {string},
            "where shadow rays go; default: as the sampler says; fixed and uniform-grid are biased",
            0,
            0,
            {"fixed", "random", "uniform-grid", "stratified", "sobol"}},
           {"candidates", {integer}, "of ris, for each shadow ray; default 32", 1, 4096},
           {"mis", {string}, "heuristic of mis; default power", 0, 0, {"balance", "power", "maximum", "cutoff"}},
           {"lanes", {string}, "paths side by side; default native", 0, 0, {"one", "native"}}}};
}

DirectSettings direct_settings(const ParameterList& list) {
  DirectSettings s;
  const std::string strategy = list.string("strategy", "mis");
  s.strategy = DirectStrategy(std::ranges::find(direct_strategy_names, strategy) - direct_strategy_names.begin());
  s.shadow_rays = list.integer("shadow-rays", s.shadow_rays);
  const std::string pattern = list.string("pattern", "");
  s.fixed = pattern == "fixed";
  if (s.fixed) s.pattern = PointSetKind::uniform_grid;
  for (const auto& [name, kind] : patterns)
    if (name == pattern) s.pattern = kind;
  s.candidates = list.integer("candidates", s.candidates);
  s.heuristic = mis_heuristic_named(list.string("mis", "power")).value_or(MisHeuristic::power);
  s.lanes = list.string("lanes", "native") == "one" ? Lanes::one : Lanes::native;
  return s;
}

}  // namespace montelux
