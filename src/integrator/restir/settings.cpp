#include "integrator/restir/settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "image/features.h"

namespace montelux {

namespace {

constexpr int max_setting = 4096;

// What has proven best: for direct light, much time behind each sample; for paths, many neighbours and no frames
// before, whose samples the mean over a series would count again.
RestirSettings defaults_of(std::string_view name, bool groups) {
  RestirSettings s;
  s.groups = groups;
  if (!groups) s.neighbours = 5, s.radius = 8;
  if (name == "restir-di") return s;
  s.temporal = false;
  s.indirect.on = true;
  if (name == "restir-pt") s.indirect.max_replayed = 4;
  if (groups)
    s.neighbours = 7, s.rounds = 3, s.radius = 4;
  else
    s.neighbours = 4, s.rounds = 2, s.radius = 6, s.similar = false;
  return s;
}

NamedValues<ReuseWeights> weights_names() {
  NamedValues<ReuseWeights> names;
  for (const NamedReuseWeights& entry : reuse_weight_names) names.emplace_back(entry.name, entry.weights);
  return names;
}

Status read_shift(const std::string& text, RestirSettings& s) {
  s.indirect.joins = text != "replay";
  if (text == "reconnection") s.indirect.max_replayed = 0;
  return Done{};
}
std::string shift_text(const RestirSettings& s) {
  return !s.indirect.joins ? "replay" : s.indirect.max_replayed > 0 ? "hybrid" : "reconnection";
}

// One row for each setting of the integrator of this name.
Fields<RestirSettings> fields_of(std::string_view name) {
  using S = RestirSettings;
  const bool paths = name != "restir-di";
  Fields<S> fields;
  fields.integer("candidates", &S::candidates, "first candidates by the light hierarchy", 0, max_setting)
      .integer("power-candidates", &S::power_candidates, "first candidates by power", 0, max_setting)
      .boolean("bsdf", &S::bsdf_candidate, "one more candidate by the BSDF")
      .other({"groups",
              {ParameterType::boolean},
              "pixels share in groups, whose samples are evaluated at all of their pixels; off: each pixel has its "
              "own neighbours; default on, off if weights are stated"})
      .integer("neighbours", &S::neighbours, "pixels that a pixel shares with in each round", 0, 16)
      .number("radius", &S::radius, "their distance in pixels; the blocks of groups have twice this size", 1,
              max_setting)
      .integer("rounds", &S::rounds, "rounds of spatial reuse", 0, 8)
      .boolean("similar", &S::similar,
               "share between similar pixels: in groups, the same object first; else similar normal and depth")
      .boolean("temporal", &S::temporal, "reuse the previous frame")
      .boolean("carry", &S::carry, "in a sequence, also reuse the previous image, with temporal=on")
      .number("m-cap", &S::m_cap, "maximum confidence of the previous frame, in frames, with temporal=on", 0, 1e6)
      .choice<ReuseWeights>("weights", &S::weights,
                            "weights of sharing without groups; stating them turns groups off; naive is biased",
                            weights_names())
      .boolean("visibility-reuse", &S::visibility_reuse, "do not pass on occluded samples")
      .integer("frames", &S::frames, "frames that share samples, which form one pass", 1, 1024)
      .formerly("chain")
      .integer("warm-up", &S::warm_up, "preceding frames that are not shown, with temporal=on", 0, 1024)
      .integer(
          "lamp-rays", [](S& s) -> int& { return s.path.lamp_rays; }, lamp_rays_meaning, 0, max_lamp_rays)
      .other(max_depth_spec())
      .choice<Lanes>(
          "lanes", [](S& s) -> Lanes& { return s.path.lanes; }, "number of pixels computed together", lanes_names());
  if (!paths) return fields;
  fields.boolean("direct", &S::direct, "also share direct light at the first rough surface")
      .number(
          "footprint", [](S& s) -> float& { return s.indirect.footprint; },
          "paths are connected where the lobes cover this area, relative to the squared depth of the first surface", 0,
          1e6);
  if (name == "restir-gi") return fields;
  // How a path is shifted decides last whether events scatter again.
  fields
      .integer(
          "replayed", [](S& s) -> int& { return s.indirect.max_replayed; }, "maximum number of replayed events", 1, 64)
      .text("shift",
            "how a path is shifted to another pixel: it is connected to the next surface, or replayed with the same "
            "numbers up to the light, or up to a surface to which it can be connected",
            read_shift, shift_text, {"reconnection", "replay", "hybrid"});
  return fields;
}
// The table's rows, with the defaults in groups and without.
std::vector<ParameterSpec> specs_of(std::string_view name) {
  return fields_of(name).specs(defaults_of(name, true), defaults_of(name, false), "without groups");
}

}  // namespace

EntitySpec restir_di_spec() {
  return {"restir-di",
          "path tracing whose direct light at the first rough surface is resampled over pixels and frames (ReSTIR DI)",
          specs_of("restir-di")};
}

EntitySpec restir_gi_spec() {
  return {"restir-gi",
          "path tracing whose light at the first rough surface is resampled over pixels and frames, if paths can be "
          "connected to the next surface (ReSTIR GI)",
          specs_of("restir-gi")};
}

EntitySpec restir_pt_spec() {
  return {"restir-pt",
          "path tracing whose paths beyond the first rough surface are resampled over pixels and frames (ReSTIR PT)",
          specs_of("restir-pt")};
}

namespace {

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
      {"warm-up", s.temporal || s.warm_up == 0, "temporal=on, without which frames share nothing"},
      {"radius", spatial, "at least one round and one neighbour"},
      {"similar", spatial, "at least one round and one neighbour"},
      {"footprint", s.indirect.joins, "shift=reconnection or shift=hybrid: others connect no paths"},
      {"replayed", s.indirect.max_replayed > 0, "shift=replay or shift=hybrid: others replay nothing"}};
  for (const Need& need : needs)
    if (list.find(need.setting) != nullptr && !need.is_met)
      return Failure{fmt::format("{}: {} has no effect here: it needs {}", name, need.setting, need.needs)};
  return Done{};
}

}  // namespace

Result<RestirSettings> restir_settings(std::string_view name, const ParameterList& list, std::optional<int> max_depth) {
  const std::string weights = list.string("weights", "");
  RestirSettings s = defaults_of(name, list.boolean("groups", weights.empty()));
  if (s.groups && !weights.empty() && weights != "generalised")
    return Failure{fmt::format("{}: groups share by generalised weights; weights={} needs groups=off", name, weights)};
  if (Status read = fields_of(name).read(list, s); !read) return read.failure();
  s.path.max_depth = max_depth;
  // A direction of the BSDF alone finds no light that is a delta, and would wait for the others.
  if (s.candidates + s.power_candidates == 0)
    return Failure{
        fmt::format("{} needs candidates on lights: candidates or power-candidates must be at least 1", name)};
  if (Status idle = refuse_idle(name, list, s); !idle) return idle.failure();
  return s;
}

}  // namespace montelux
