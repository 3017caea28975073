#include "integral_output.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "api/json_text.h"
#include "api/render.h"
#include "progress.h"
#include "status.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;
using lab::IntegralResult;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

bool has_interval(const IntegralResult& r) { return std::isfinite(r.interval.low) && std::isfinite(r.interval.high); }

// The ends of an interval, to a tenth of its standard error.
std::string interval_text(const IntegralResult& r) {
  if (r.found_nothing) return "unknown: no sample found anything";
  if (!has_interval(r)) return "unknown from one pass";
  const double width = r.interval.high - r.interval.low;
  const double size = std::max(std::abs(r.interval.low), std::abs(r.interval.high));
  const int digits = width > 0 ? std::clamp(int(std::ceil(std::log10(size / width))) + 3, 3, 16) : 16;
  return fmt::format("{:.{}g} to {:.{}g} with confidence {:g}", r.interval.low, digits, r.interval.high, digits,
                     r.confidence);
}

std::string stop_text(const IntegralResult& r) {
  switch (r.stopped_because) {
    case lab::StopReason::samples:
      return "the samples were used up";
    case lab::StopReason::seconds:
      return "the time was used up";
    case lab::StopReason::target_error:
      return "the target error was reached";
    case lab::StopReason::nothing_found:
      return "no sample found anything, the target error cannot be reached";
    case lab::StopReason::rounding:
      return "the error is that of rounding, the target error cannot be reached";
    case lab::StopReason::stopped:
      break;
  }
  return "it was interrupted";
}

std::string method_text(const IntegralRun& run) {
  const std::string did = lab::to_text(run.result.method);
  return did == run.method || run.method != "auto" ? did : fmt::format("{} (chosen by auto)", did);
}

void print_one(const IntegralRun& run) {
  const IntegralResult& r = run.result;
  const double seconds = std::max(r.seconds, 1e-9);
  fmt::print("{}\n", lab::value_with_error(r.mean, r.standard_error));
  fmt::print("interval     {}\n", interval_text(r));
  fmt::print("method       {}\n", method_text(run));
  if (!r.why.empty()) fmt::print("because      {}\n", r.why);
  fmt::print("evaluations  {} in {} passes", r.evaluations, r.passes);
  if (r.training_evaluations > 0) fmt::print(", {} of them for training", r.training_evaluations);
  fmt::print("\nvariance     {:.4g} of one sample\n", r.variance_of_one_sample);
  fmt::print("time         {}, {}\n", time_text(seconds), count_text(double(r.evaluations) / seconds, "evaluations/s"));
  fmt::print("efficiency   {:.3g}, 1 / (variance x seconds)\n", r.efficiency);
  fmt::print("passes       chi2/dof {:.3g}, Q {:.2g}\n", r.chi2_per_dof, r.q);
  if (r.acceptance) fmt::print("accepted     {:.3g} % of the points\n", 100 * *r.acceptance);
  if (r.coefficient) fmt::print("coefficient  {:.6g} of the control variate\n", *r.coefficient);
  if (const auto& o = r.outside_map)
    fmt::print("outside map  {} by uniform points, {} by those of the map\n",
               lab::value_with_error(o->by_uniform, o->uniform_error), lab::value_with_error(o->by_map, o->map_error));
  if (r.map_worth)
    fmt::print("map          a sample is worth {:.3g} of one that follows the integrand\n", *r.map_worth);
  fmt::print("ended        {}\n", stop_text(r));
}

// Columns as wide as their longest cell; the first aligned left, the others right.
void print_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  for (const auto& row : rows) {
    std::string line = fmt::format("{:<{}}", row[0], widths[0]);
    for (std::size_t c = 1; c < row.size(); ++c) line += fmt::format("  {:>{}}", row[c], widths[c]);
    fmt::print("{}\n", line);
  }
}

void print_comparison(const std::vector<IntegralRun>& runs) {
  // Efficiencies as multiples of that of the first method.
  const double first = runs.front().result.efficiency;
  std::vector<std::vector<std::string>> rows{
      {"method", "value", "variance", "evaluations", "passes", "time", "chi2/dof", "Q", "efficiency", "of first"}};
  for (const IntegralRun& run : runs) {
    const IntegralResult& r = run.result;
    const std::string name = run.method == lab::to_text(r.method) || run.method != "auto"
                                 ? run.method
                                 : fmt::format("auto: {}", lab::to_text(r.method));
    rows.push_back({name, lab::value_with_error(r.mean, r.standard_error),
                    fmt::format("{:.3g}", r.variance_of_one_sample), fmt::format("{}", r.evaluations),
                    fmt::format("{}", r.passes), time_text(r.seconds), fmt::format("{:.2f}", r.chi2_per_dof),
                    fmt::format("{:.2g}", r.q), fmt::format("{:.3g}", r.efficiency),
                    first > 0 ? fmt::format("{:.3g} x", r.efficiency / first) : "-"});
  }
  print_table(rows);
  for (const IntegralRun& run : runs)
    if (!run.result.why.empty())
      fmt::print("{} took {}: {}\n", run.method, lab::to_text(run.result.method), run.result.why);
}

std::string_view name_of(lab::IntegralWarning::Kind kind) {
  using enum lab::IntegralWarning::Kind;
  switch (kind) {
    case non_finite:
      return "non-finite";
    case heavy_tail:
      return "heavy-tail";
    case may_not_exist:
      return "may-not-exist";
    case nothing_found:
      return "nothing-found";
    case outside_map:
      return "outside-map";
    case map_fit:
      return "map-fit";
    case disagreement:
      return "disagreement";
    case control_integral:
      return "control-integral";
    case missed_region:
      return "missed-region";
    case density:
      return "density";
    case inconsistent:
      return "inconsistent";
    case few_passes:
      return "few-passes";
    case target:
      break;
  }
  return "target";
}

Json to_json(const IntegralRun& run) {
  const IntegralResult& r = run.result;
  Json json;
  json["mean"] = number_or_null(r.mean);
  json["standard_error"] = number_or_null(r.standard_error);
  json["interval"] = has_interval(r) ? Json::array({r.interval.low, r.interval.high}) : Json();
  json["confidence"] = r.confidence;
  json["evaluations"] = r.evaluations, json["training_evaluations"] = r.training_evaluations;
  json["variance_of_one_sample"] = number_or_null(r.variance_of_one_sample);
  json["seconds"] = r.seconds, json["efficiency"] = number_or_null(r.efficiency);
  json["chi2_per_dof"] = number_or_null(r.chi2_per_dof), json["q"] = number_or_null(r.q);
  json["passes"] = r.passes, json["non_finite"] = r.non_finite;
  json["hill_index"] = number_or_null(r.tail.hill_index), json["largest_share"] = number_or_null(r.tail.largest_share);
  json["heavy_tail"] = r.tail.heavy;
  json["outside_map"] = Json();
  if (const auto& o = r.outside_map)
    json["outside_map"] = {{"by_uniform", o->by_uniform},
                           {"by_uniform_error", o->uniform_error},
                           {"by_map", o->by_map},
                           {"by_map_error", o->map_error},
                           {"missed", o->missed}};
  json["map_worth"] = or_null(r.map_worth);
  json["acceptance"] = or_null(r.acceptance), json["coefficient"] = or_null(r.coefficient);
  json["asked"] = run.method, json["method"] = lab::to_text(r.method), json["reason"] = r.why;
  json["stopped_because"] = lab::name_of(r.stopped_because), json["target_reached"] = r.target_reached;
  json["warnings"] = Json::array();
  for (const lab::IntegralWarning& w : r.warnings)
    json["warnings"].push_back({{"kind", name_of(w.kind)}, {"message", w.message}});
  json["seed"] = r.state.seed;
  return json;
}

// A cell of a CSV file (RFC 4180).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

void print_integral_text(const std::vector<IntegralRun>& runs, bool brief) {
  if (runs.size() == 1 && !brief) return print_one(runs.front());
  if (!brief) return print_comparison(runs);
  for (const IntegralRun& run : runs)
    fmt::print("{}\n", lab::value_with_error(run.result.mean, run.result.standard_error));
}

void print_integral_json(const IntegralOptions& options, const std::vector<IntegralRun>& runs) {
  Json json;
  json["version"] = version();
  json["integrand"] = options.statement.integrand, json["over"] = options.statement.over;
  if (runs.size() == 1)
    json.update(to_json(runs.front()));
  else
    for (const IntegralRun& run : runs) json["results"].push_back(to_json(run));
  if (runs.size() > 1) {
    json["disagreements"] = Json::array();
    for (const lab::Disagreement& d : disagreements_of(runs))
      json["disagreements"].push_back({{"first", d.first},
                                       {"second", d.second},
                                       {"difference", d.difference},
                                       {"standard_error", d.standard_error},
                                       {"message", lab::to_text(d)}});
  }
  fmt::print("{}\n", json_text(std::move(json), 2));
}

void print_integral_csv(const std::vector<IntegralRun>& runs) {
  fmt::print(
      "method,mean,standard_error,low,high,confidence,evaluations,variance_of_one_sample,seconds,efficiency,"
      "chi2_per_dof,q,passes,non_finite,heavy_tail,stopped_because,seed\n");
  for (const IntegralRun& run : runs) {
    const IntegralResult& r = run.result;
    fmt::print("{},{:.17g},{:.17g},{:.17g},{:.17g},{:g},{},{:.17g},{:.6g},{:.17g},{:.17g},{:.17g},{},{},{},{},{}\n",
               cell(lab::to_text(r.method)), r.mean, r.standard_error, r.interval.low, r.interval.high, r.confidence,
               r.evaluations, r.variance_of_one_sample, r.seconds, r.efficiency, r.chi2_per_dof, r.q, r.passes,
               r.non_finite, r.tail.heavy ? 1 : 0, lab::name_of(r.stopped_because), r.state.seed);
  }
}

void print_integral_warnings(const std::vector<IntegralRun>& runs) {
  for (const IntegralRun& run : runs)
    for (const lab::IntegralWarning& warning : run.result.warnings)
      warn(runs.size() == 1 ? warning.message : fmt::format("{}: {}", run.method, warning.message));
  for (const lab::Disagreement& d : disagreements_of(runs)) warn(lab::to_text(d));
}

void add_output_options(CLI::App& verb, IntegralOutput& output) {
  verb.add_flag("--json", output.json, "results as one JSON object");
  verb.add_flag("--csv", output.csv, "results as a table of comma-separated values")->excludes("--json");
  verb.add_flag("--quiet", output.quiet, "no progress, notes or warnings, and only the values of the results");
  verb.add_flag("--strict", output.strict, "exit status 1 if a result has a warning");
}

int print_integrals(const IntegralOutput& output, const IntegralOptions& options,
                    const std::vector<IntegralRun>& runs) {
  if (output.json)
    print_integral_json(options, runs);
  else if (output.csv)
    print_integral_csv(runs);
  else
    print_integral_text(runs, output.quiet);
  std::fflush(stdout);
  if (!output.quiet) print_integral_warnings(runs);
  return output.strict && has_warnings(runs) ? differs : done;
}

}  // namespace montelux::cli
