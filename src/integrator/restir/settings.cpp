#include "integrator/restir/settings.h"

#include <fmt/format.h>

#include <algorithm>

namespace montelux {

namespace {

constexpr int most = 4096;

// What has proven best: for direct light, much time behind each sample; for paths, many neighbours and no frames
// before, whose samples the mean over a chain would count again.
RestirSettings defaults_of(std::string_view name, bool groups) {
  RestirSettings s;
  s.groups = groups;
  if (!groups) s.neighbours = 5, s.radius = 8;
  if (name == "restir-di") return s;
  s.temporal = false;
  s.indirect.on = true;
  if (name == "restir-pt") s.indirect.most_replayed = 4;
  if (groups)
    s.neighbours = 7, s.rounds = 3, s.radius = 4;
  else
    s.neighbours = 4, s.rounds = 2, s.radius = 6, s.similar = false;
  return s;
}

std::vector<ParameterSpec> common_parameters(bool paths) {
  using enum ParameterType;
  return {
      {"candidates", {integer}, "first candidates by the light hierarchy; default 4", 0, most},
      {"power-candidates", {integer}, "first candidates by power; default 0", 0, most},
      {"bsdf", {boolean}, "one more candidate by the BSDF; default on"},
      {"groups",
       {boolean},
       "pixels share in groups, whose samples are all tried at all of their pixels; off: each has neighbours of its "
       "own; default on, off where weights are stated"},
      {"neighbours",
       {integer},
       paths ? "pixels that a pixel learns from in each round; default 7, without groups 4"
             : "pixels that a pixel learns from in each round; default 15, without groups 5",
       0,
       16},
      {"radius",
       {number},
       paths ? "how far they are, in pixels: groups are of one block of twice as many; default 4, without groups 6"
             : "how far they are, in pixels: groups are of one block of twice as many; default 2, without groups 8",
       1,
       most},
      {"rounds",
       {integer},
       paths ? "rounds of spatial reuse; default 3, without groups 2" : "rounds of spatial reuse; default 1",
       0,
       8},
      {"similar",
       {boolean},
       paths ? "share among alike: in groups, the same object first (default on); else the same normal and depth "
               "(default off)"
             : "share among alike: in groups, the same object first; else the same normal and depth; default on"},
      {"temporal",
       {boolean},
       paths ? "learn from the frame before; default off" : "learn from the frame before; default on"},
      {"carry", {boolean}, "in a sequence, learn from the picture before, too; default on with temporal=on"},
      {"m-cap", {number}, "most confidence of the frame before, in new frames; default 20; with temporal=on", 0, 1e6},
      {"weights",
       {string},
       "how reservoirs share without groups, which stating them turns off; naive is biased; default pairwise",
       0,
       0,
       {"naive", "unbiased", "pairwise", "generalised"}},
      {"visibility-reuse", {boolean}, "samples that are hidden are not passed on; default on"},
      {"chain", {integer}, "frames that learn from each other: a pass; default 16", 1, 1024},
      {"warm-up", {integer}, "frames before those, which are not shown; default 0; with temporal=on", 0, 1024},
      {"maxdepth",
       {integer},
       "maximum number of bounces; default: as the scene states, else none",
       0,
       2147483647,
       {"none"}},
      {"lanes", {string}, "pixels side by side; default native", 0, 0, {"one", "native"}}};
}

std::vector<ParameterSpec> path_parameters() {
  using enum ParameterType;
  std::vector<ParameterSpec> all = common_parameters(true);
  all.push_back({"direct", {boolean}, "direct light at the first rough surface is shared, too; default on"});
  all.push_back({"footprint",
                 {number},
                 "paths are joined where the lobes cover this area, over the squared depth of the first surface; "
                 "default 0.001",
                 0,
                 1e6});
  return all;
}

}  // namespace

EntitySpec restir_di_spec() {
  return {"restir-di",
          "path tracing whose direct light at the first rough surface is resampled over pixels and frames (ReSTIR DI)",
          common_parameters(false)};
}

EntitySpec restir_gi_spec() {
  return {"restir-gi",
          "path tracing whose light at the first rough surface is resampled over pixels and frames, where paths can be "
          "joined to the next surface (ReSTIR GI)",
          path_parameters()};
}

EntitySpec restir_pt_spec() {
  using enum ParameterType;
  std::vector<ParameterSpec> all = path_parameters();
  all.push_back(
      {"shift",
       {string},
       "how a path becomes another pixel's: it is joined to the next surface, or scatters again with the same "
       "numbers as far as the light, or as far as a surface to which it can be joined; default hybrid",
       0,
       0,
       {"reconnection", "replay", "hybrid"}});
  all.push_back({"replayed", {integer}, "most events that scatter again; default 4", 1, 64});
  return {"restir-pt",
          "path tracing whose paths behind the first rough surface are resampled over pixels and frames (ReSTIR PT)",
          all};
}

namespace {

void read_path_reuse(std::string_view name, const ParameterList& list, RestirSettings& s) {
  s.direct = list.boolean("direct", s.direct);
  s.indirect.footprint = list.number("footprint", s.indirect.footprint);
  if (name == "restir-gi") return;
  const std::string shift = list.string("shift", "hybrid");
  s.indirect.joins = shift != "replay";
  s.indirect.most_replayed = shift == "reconnection" ? 0 : list.integer("replayed", s.indirect.most_replayed);
}

// What is stated and would decide nothing, with what it needs.
Status refuse_idle(std::string_view name, const ParameterList& list, const RestirSettings& s) {
  const bool spatial = s.rounds > 0 && s.neighbours > 0;
  struct Need {
    const char* setting;
    bool is_met;
    const char* needs;
  };
  const Need needs[] = {
      {"m-cap", s.temporal, "temporal=on"},
      {"carry", s.temporal || !s.carry, "temporal=on"},
      {"warm-up", s.temporal || s.warm_up == 0, "temporal=on, without which frames teach nothing"},
      {"radius", spatial, "at least one round and one neighbour"},
      {"similar", spatial, "at least one round and one neighbour"},
      {"footprint", s.indirect.joins, "shift=reconnection or shift=hybrid: others join no paths"},
      {"replayed", s.indirect.most_replayed > 0, "shift=replay or shift=hybrid: others scatter nothing again"}};
  for (const Need& need : needs)
    if (list.find(need.setting) != nullptr && !need.is_met)
      return Failure{fmt::format("{}: {} decides nothing here: it needs {}", name, need.setting, need.needs)};
  return Done{};
}

}  // namespace

Result<RestirSettings> restir_settings(std::string_view name, const ParameterList& list, std::optional<int> max_depth) {
  const std::string weights = list.string("weights", "");
  RestirSettings s = defaults_of(name, list.boolean("groups", weights.empty()));
  if (s.groups && !weights.empty() && weights != "generalised")
    return Failure{fmt::format("{}: groups share by generalised weights; weights={} needs groups=off", name, weights)};
  s.candidates = list.integer("candidates", s.candidates);
  s.power_candidates = list.integer("power-candidates", s.power_candidates);
  s.bsdf_candidate = list.boolean("bsdf", s.bsdf_candidate);
  s.neighbours = list.integer("neighbours", s.neighbours);
  s.radius = list.number("radius", s.radius);
  s.rounds = list.integer("rounds", s.rounds);
  s.similar = list.boolean("similar", s.similar);
  s.temporal = list.boolean("temporal", s.temporal);
  s.carry = list.boolean("carry", s.carry);
  s.m_cap = list.number("m-cap", s.m_cap);
  s.weights = *reuse_weights_named(weights.empty() ? "pairwise" : weights);
  s.visibility_reuse = list.boolean("visibility-reuse", s.visibility_reuse);
  s.chain = list.integer("chain", s.chain);
  s.warm_up = list.integer("warm-up", s.warm_up);
  s.path.max_depth = max_depth;
  s.path.lanes = list.string("lanes", "native") == "one" ? Lanes::one : Lanes::native;
  // A direction of the BSDF alone finds no light that is a delta, and would wait for the others.
  if (s.candidates + s.power_candidates == 0)
    return Failure{
        fmt::format("{} needs candidates on lights: candidates or power-candidates must be at least 1", name)};
  if (name != "restir-di") read_path_reuse(name, list, s);
  if (Status idle = refuse_idle(name, list, s); !idle) return idle.failure();
  return s;
}

}  // namespace montelux
