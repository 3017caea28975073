// Integrals in files: the statement, the budget, and the state of each method, as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "api/integrate.h"
#include "api/render.h"
#include "api/saved_file.h"

namespace montelux {

namespace {

using Json = nlohmann::ordered_json;

constexpr SavedFormat saved_format{"montelux integrals", 3, "montelux integrate --save", "integral"};

Json statement_json(const lab::IntegralStatement& s) {
  return {{"integrand", s.integrand},
          {"over", s.over},
          {"pdf", s.densities},
          {"normalize_pdf", s.normalize_densities},
          {"allow_missed", s.allow_missed},
          {"control", or_null<Json>(s.control)},
          {"control_integral", or_null<Json>(s.control_integral)},
          {"target", or_null<Json>(s.target)}};
}
lab::IntegralStatement statement_from(const Json& j) {
  lab::IntegralStatement s;
  s.integrand = j.at("integrand"), s.over = j.at("over").get<std::vector<std::string>>();
  s.densities = j.at("pdf").get<std::vector<std::string>>();
  s.normalize_densities = j.at("normalize_pdf"), s.allow_missed = j.at("allow_missed");
  s.control = optional_at<std::string>(j, "control");
  s.control_integral = optional_at<std::string>(j, "control_integral");
  s.target = optional_at<std::string>(j, "target");
  return s;
}

Json budget_json(const lab::Budget& b) {
  return {{"samples", or_null<Json>(b.samples)},
          {"seconds", or_null<Json>(b.seconds)},
          {"target_error", or_null<Json>(b.target_error)},
          {"target_is_relative", b.target_is_relative},
          {"confidence", b.confidence}};
}
lab::Budget budget_from(const Json& j) {
  lab::Budget b;
  constexpr std::uint64_t max_samples = std::uint64_t(1) << 62;
  if (const Json& samples = j.at("samples"); !samples.is_null())
    b.samples = whole_from<std::uint64_t>(samples, 0, max_samples);
  b.seconds = optional_at<double>(j, "seconds");
  b.target_error = optional_at<double>(j, "target_error"), b.target_is_relative = j.at("target_is_relative");
  b.confidence = j.at("confidence");
  return b;
}

SavedIntegral saved_from(const Json& j) {
  SavedIntegral saved;
  saved.options.statement = statement_from(j.at("statement"));
  saved.options.methods = j.at("methods").get<std::vector<std::string>>();
  saved.options.budget = budget_from(j.at("budget"));
  saved.options.seed = whole_from<std::uint64_t>(j.at("seed"), 0, std::numeric_limits<std::uint64_t>::max());
  for (const Json& run : j.at("runs")) {
    saved.methods.push_back(run.at("method"));
    saved.states.push_back(lab::state_from_json(run.at("state").dump()));
  }
  if (saved.states.empty() || saved.states.size() > saved.options.methods.size())
    throw std::invalid_argument("its runs do not match its methods");
  return saved;
}

}  // namespace

Status save_integral(const std::filesystem::path& file, const SavedIntegral& saved) {
  Json runs = Json::array();
  for (std::size_t k = 0; k < saved.states.size(); ++k)
    runs.push_back({{"method", saved.methods[k]}, {"state", Json::parse(lab::to_json(saved.states[k]))}});
  Json json{{"format", saved_format.name},
            {"version", saved_format.version},
            {"program", version()},
            {"statement", statement_json(saved.options.statement)},
            {"methods", saved.options.methods},
            {"budget", budget_json(saved.options.budget)},
            {"seed", saved.options.seed},
            {"runs", runs}};
  return save_json(file, std::move(json));
}

Result<SavedIntegral> load_integral(const std::filesystem::path& file) {
  return load_saved<Json>(file, saved_format, saved_from);
}

bool is_saved_integral(const std::filesystem::path& file) { return begins_as(file, saved_format); }

Status check_integral_file(const std::filesystem::path& file) { return check_saved_target(file, saved_format); }

Result<SavedIntegral> merge_integrals(const std::vector<SavedIntegral>& parts) {
  if (parts.empty()) return Failure{"there is nothing to merge"};
  SavedIntegral total = parts.front();
  for (const SavedIntegral& part : parts) {
    const Json a = statement_json(total.options.statement), b = statement_json(part.options.statement);
    for (const auto& [key, value] : a.items())
      if (b.at(key) != value)
        return Failure{
            fmt::format("the files are of different integrals: {} is {} and {}", key, value.dump(), b.at(key).dump())};
    if (part.methods != total.methods)
      return Failure{fmt::format("the files are of different methods: {} and {}", fmt::join(total.methods, ", "),
                                 fmt::join(part.methods, ", "))};
  }
  try {
    for (std::size_t k = 0; k < total.states.size(); ++k) {
      std::vector<lab::IntegralState> states;
      for (const SavedIntegral& part : parts) states.push_back(part.states[k]);
      total.states[k] = lab::merge(states);
    }
  } catch (const std::invalid_argument& error) {
    return Failure{error.what()};
  }
  return total;
}

}  // namespace montelux
