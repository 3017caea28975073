#include "compare_output.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "api/json_text.h"
#include "api/render.h"
#include "progress.h"
#include "shortcomings.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;
using lab::Measured;
using lab::MethodResult;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const Measured& m) {
  return {{"mean", m.count > 0 ? number(m.mean) : Json()},
          {"interval", {number(m.low), number(m.high)}},
          {"standard_error", number(m.standard_error)}};
}

Json to_json(const lab::ByMeasure<Measured>& by) {
  Json json = Json::object();
  for (lab::ErrorMeasure measure : lab::error_measures) json[std::string(lab::key_of(measure))] = to_json(by[measure]);
  return json;
}

Json to_json(const WelchScale& scale) {
  return {{"tests", scale.tests}, {"smallest_p", scale.smallest_p}, {"t", number(scale.t)}, {"differs", scale.differs}};
}

Json to_json(const lab::Agreement& a) {
  constexpr const char* outcomes[] = {"agrees", "differs", "too few repeats"};
  return {{"outcome", outcomes[std::size_t(a.outcome)]},
          {"level", a.level},
          {"channel", std::string(1, "RGB"[a.channel])},
          {"difference", number(a.difference)},
          {"standard_error", number(a.standard_error)},
          {"degrees_of_freedom", number(a.degrees_of_freedom)},
          {"t", number(a.t)},
          {"p_value", a.p_value},
          {"detectable_bias", number(a.detectable)},
          {"power", lab::Agreement::power},
          {"pixel_t", number(a.pixel_t)},
          {"pixel_p_value", a.pixel_p_value}};
}

// The shares of the variance by family and layer.
Json to_json(const lab::Attribution& attribution) {
  Json json = Json::object();
  for (const lab::FamilyShares& family : attribution.families)
    for (const lab::LayerShare& layer : family.layers) json[family.name][layer.name] = to_json(layer.share);
  return json;
}

Json to_json(const MethodResult& m, const MethodShortcomings& lacks, const std::vector<std::string>& left_out) {
  Json json;
  json["label"] = m.compared_method.label;
  json["name"] = m.compared_method.shown_name();
  json["method"] = m.compared_method.text;
  json["sampler"] = name_of(m.compared_method.sampler);
  json["biases"] = m.compared_method.biases;
  json["repeats"] = m.repeats.size();
  json["mse"] = to_json(m.mse);
  json["relative_mse"] = to_json(m.relative_mse);
  json["flip"] = to_json(m.flip);
  json["variance"] = to_json(m.variance);
  json["seconds"] = to_json(m.seconds);
  json["warm_up_seconds"] = to_json(m.warm_up);
  json["seconds_with_warm_up"] = to_json(m.all_seconds);
  json["samples"] = to_json(m.samples);
  json["rays"] = to_json(m.rays);
  json["efficiency"] = to_json(m.efficiency);
  json["efficiency_with_warm_up"] = to_json(m.whole_efficiency);
  json["coverage"] = to_json(m.coverage);
  json["slope_by_samples"] = to_json(m.slope_by_samples);
  json["slope_by_time"] = to_json(m.slope_by_time);
  json["agreement"] = m.repeats.empty() ? Json() : to_json(m.agreement);
  json["bias_squared"] = to_json(m.bias_squared);
  json["bias"] = {{"blocks", to_json(m.bias.blocks)}, {"pixels", to_json(m.bias.pixels)}};
  json["non_finite"] = m.non_finite;
  Json curve = Json::array();
  for (const lab::ConvergencePoint& p : m.convergence)
    curve.push_back({{"samples", p.samples}, {"mse", to_json(p.mse)}, {"seconds", to_json(p.seconds)}});
  json["convergence"] = curve;
  json["attribution"] = m.attribution ? to_json(*m.attribution) : Json();
  add_to(json, {lacks.missing, lacks.replaced, left_out});
  return json;
}

Json to_json(const lab::PairVerdict& v, const Comparison& comparison) {
  const lab::ComparisonResult& r = comparison.result;
  const std::string &first = r.methods[v.first].compared_method.shown_name(),
                    &second = r.methods[v.second].compared_method.shown_name();
  const bool decided = v.decided && comparison.refusal.empty();
  const int winner = decided ? lab::winner_of(v.ratio[r.measure]) : 0;
  Json opposite = Json::array();
  for (lab::ErrorMeasure m : lab::error_measures)
    if (winner != 0 && lab::winner_of(v.ratio[m]) == -winner) opposite.push_back(lab::key_of(m));
  constexpr const char* likeness[] = {"none", "settings", "pictures"};
  return {{"first", first},
          {"second", second},
          {"decided", decided},
          {"winner", winner == 0 ? Json() : Json(winner > 0 ? first : second)},
          {"opposite_by", opposite},
          {"efficiency_ratio", to_json(v.ratio)},
          {"efficiency_ratio_with_warm_up", to_json(v.whole_ratio)},
          {"times_longer_to_decide", number(v.times_longer)},
          {"alike", likeness[std::size_t(v.likeness)]},
          {"sentence", sentence_of(comparison, v, comparison.saved.options.confidence)}};
}

// "variance by bounces: bounce1 62.0 ± 3.1 %, ..."; shares below half a percent are omitted.
void print_attribution(const lab::Attribution& attribution) {
  for (const lab::FamilyShares& family : attribution.families) {
    if (family.layers.size() < 2) continue;
    std::string line;
    for (const lab::LayerShare& layer : family.layers) {
      const Measured& share = layer.share;
      if (!(std::abs(share.mean) >= 0.005)) continue;
      const lab::Measured percent{100 * share.mean, 100 * share.low, 100 * share.high, 100 * share.standard_error,
                                  share.count};
      line += fmt::format("{}{} {} %", line.empty() ? "" : ", ", layer.name, text_of(percent));
    }
    fmt::print("   variance by {}: {}\n", family.name, line.empty() ? "there is none" : line);
  }
}

// How often a method's own intervals contain the reference.
std::string coverage_text(const Measured& m) {
  return m.count == 0 ? "no 95 % intervals of its own, which need two passes"
                      : fmt::format("own 95 % intervals contain it {:.1f} %", 100 * m.mean);
}

void print_method(const Comparison& comparison, std::size_t i) {
  const lab::ComparisonResult& r = comparison.result;
  const MethodResult& m = r.methods[i];
  const ComparisonOptions& options = comparison.saved.options;
  const auto title = lab::title_of(r.measure);
  fmt::print("{}\n", m.compared_method.shown_name());
  // What reading the scene omitted does not depend on the method: it is among the conditions.
  print_text(Shortcomings{comparison.shortcomings[i].missing, comparison.shortcomings[i].replaced, {}}, 9, "   ");
  if (m.repeats.empty()) {
    fmt::print("   no repeat was done\n");
    return;
  }
  fmt::print("   relMSE {}   MSE {}   FLIP {}\n", text_of(m.relative_mse), text_of(m.mse), text_of(m.flip));
  fmt::print("   {} repeats of {}{} and {:.4g} {} a pixel, {}\n", m.repeats.size(), time_text(m.seconds.mean),
             options.processor_time ? " on processors" : "", m.samples.mean, m.samples.mean == 1 ? "sample" : "samples",
             count_text(m.rays.mean, "rays"));
  fmt::print("   efficiency by {} {}\n", title, text_of(m.efficiency[r.measure]));
  if (!r.warm_up_counts && m.warm_up.mean > 0)
    fmt::print("   not counted: {} of warm-up in each repeat; efficiency including it {}\n", time_text(m.warm_up.mean),
               text_of(m.whole_efficiency[r.measure]));
  fmt::print("   slope by samples {}   {}\n", text_of(m.slope_by_samples), coverage_text(m.coverage));
  fmt::print("   {}\n", sentence_of(m.agreement, lab::mean_value(r.reference.mean)));
  if (m.attribution) print_attribution(*m.attribution);
}

}  // namespace

void print_comparison_text(const std::string& scene, const Comparison& comparison) {
  for (const auto& [name, value] : conditions_of(comparison, scene)) fmt::print("{}: {}\n", name, value);
  fmt::print("took: {}, predicted {}\n\n", time_text(comparison.seconds), time_text(comparison.forecast.total()));
  for (std::size_t i = 0; i < comparison.result.methods.size(); ++i) print_method(comparison, i);
  fmt::print("\n");
  for (const lab::PairVerdict& v : comparison.result.verdicts)
    fmt::print("{}\n", sentence_of(comparison, v, comparison.saved.options.confidence));
}

void print_comparison_json(const std::string& scene, const Comparison& comparison) {
  const lab::ComparisonResult& r = comparison.result;
  const ComparisonOptions& options = comparison.saved.options;
  Json json;
  json["version"] = version();
  json["scene"] = scene;
  json["resolution"] = {r.reference.mean.width, r.reference.mean.height};
  json["seed"] = options.seed;
  json["confidence"] = options.confidence;
  json["measure"] = lab::key_of(r.measure);
  json["settings"] = Json::object();
  for (const auto& [key, value] : options.settings) json["settings"][key] = value;
  Json shares = Json::object();
  for (lab::ErrorMeasure m : lab::error_measures) shares[std::string(lab::key_of(m))] = number(r.reference_share[m]);
  json["reference"] = {{"origin", r.reference.origin}, {"share_of_smallest_error", shares}};
  json["refused"] = comparison.refusal.empty() ? Json() : Json(comparison.refusal);
  json["interrupted"] = r.interrupted;
  json["warm_up_counts"] = r.warm_up_counts;
  json["clock"] = options.processor_time ? "processor" : "wall";
  json["predicted_seconds"] = number(comparison.forecast.total());
  json["seconds"] = comparison.seconds;
  json["methods"] = Json::array();
  for (std::size_t i = 0; i < r.methods.size(); ++i)
    json["methods"].push_back(to_json(r.methods[i], comparison.shortcomings[i], comparison.left_out));
  json["verdicts"] = Json::array();
  for (const lab::PairVerdict& v : r.verdicts) json["verdicts"].push_back(to_json(v, comparison));
  fmt::print("{}\n", json_text(std::move(json), 2));
}

void print_comparison_csv(const Comparison& comparison) {
  fmt::print("name,method,repeat,seconds,samples,rays,mse,relative_mse,flip,variance,coverage");
  // The layers are those of the scene, so all methods that have them have the same.
  std::vector<std::string> layers;
  for (const MethodResult& m : comparison.result.methods)
    if (layers.empty() && m.compared_method.layers) layers = layer_names(*m.compared_method.layers);
  if (!comparison.result.warm_up_counts) fmt::print(",warm_up_seconds");
  for (const std::string& name : layers) fmt::print(",share_{}", name);
  fmt::print("\n");
  // Unknown values have an empty cell.
  const auto cell = [](double value) {
    return std::isfinite(value) ? fmt::format(",{:.9g}", value) : std::string(",");
  };
  for (std::size_t k = 0; k < comparison.result.methods.size(); ++k) {
    const MethodResult& m = comparison.result.methods[k];
    const std::vector<lab::AttributionRound>& attribution = comparison.saved.state.methods[k].attribution;
    for (std::size_t i = 0; i < m.repeats.size(); ++i) {
      const lab::Repeat& r = m.repeats[i];
      std::string line = fmt::format("\"{}\",\"{}\",{}", m.compared_method.shown_name(), m.compared_method.text, i);
      for (double value : {r.seconds, r.samples, r.rays, r.mse, r.relative_mse, r.flip, r.variance, r.coverage})
        line += cell(value);
      if (!comparison.result.warm_up_counts) line += cell(r.warm_up);
      for (std::size_t layer = 0; layer < layers.size(); ++layer)
        line += attribution.empty() ? "," : cell(attribution[i].layers[layer] / attribution[i].all);
      fmt::print("{}\n", line);
    }
  }
}

std::string forecast_text(const ComparisonForecast& forecast, int repeats, std::size_t methods) {
  std::string text = fmt::format("about {}: ", time_text(forecast.total()));
  if (forecast.pilots > 0) text += fmt::format("pilots {}, ", time_text(forecast.pilots));
  if (forecast.reference > 0) text += fmt::format("reference {}, ", time_text(forecast.reference));
  return text + fmt::format("{} repeats of {} methods with slopes and attribution {}", repeats, methods,
                            time_text(forecast.repeats));
}

}  // namespace montelux::cli
