#include "api/integrate.h"

#include <algorithm>
#include <stdexcept>

namespace montelux {

namespace {

std::vector<std::string> default_methods(const lab::IntegralStatement& statement) {
  if (statement.densities.size() > 1) return {"mis"};
  if (!statement.densities.empty()) return {"importance"};
  if (statement.control) return {"control"};
  if (statement.target) return {"ris"};
  return {"auto"};
}

}  // namespace

IntegralPreparation prepare_integral(const IntegralOptions& options) {
  IntegralPreparation preparation;
  PreparedIntegral integral{options, {}, {}};
  lab::Budget& budget = integral.options.budget;
  if (!budget.samples && !budget.seconds && !budget.target_error) budget.samples = default_integral_samples;
  if (options.methods.empty()) integral.options.methods = default_methods(options.statement);
  for (const std::string& text : integral.options.methods)
    if (auto method = lab::parse_method(text))
      integral.methods.push_back(*method);
    else
      preparation.mistakes.push_back("--method: " + method.error());
  lab::StatementReading reading = lab::read_statement(options.statement, integral.methods);
  preparation.mistakes.insert(preparation.mistakes.end(), reading.mistakes.begin(), reading.mistakes.end());
  preparation.notes = std::move(reading.notes);
  if (!preparation.mistakes.empty()) return preparation;
  integral.stated = std::move(*reading.stated);
  preparation.integral = std::move(integral);
  return preparation;
}

Result<std::vector<IntegralRun>> run_integral(const PreparedIntegral& integral, const IntegralWatch& watch,
                                              const SavedIntegral* resume) {
  std::vector<IntegralRun> runs;
  try {
    for (std::size_t k = 0; k < integral.methods.size(); ++k) {
      lab::Execution execution;
      execution.seed = integral.options.seed, execution.threads = watch.threads, execution.stop = watch.stop;
      if (watch.progress)
        execution.observer = [&watch, k](const lab::IntegralProgress& progress) { watch.progress(k, progress); };
      if (resume && k < resume->states.size()) execution.resume = resume->states[k];
      runs.push_back({integral.options.methods[k], lab::integrate(integral.stated.problem, integral.methods[k],
                                                                  integral.options.budget, execution)});
      if (runs.back().result.stopped_because == lab::StopReason::stopped) break;
    }
  } catch (const std::invalid_argument& error) {
    return Failure{error.what()};
  }
  return runs;
}

SavedIntegral saved_of(const PreparedIntegral& integral, const std::vector<IntegralRun>& runs) {
  SavedIntegral saved{integral.options, {}, {}};
  for (const IntegralRun& run : runs) {
    saved.methods.push_back(run.method);
    saved.states.push_back(run.result.state);
  }
  return saved;
}

std::vector<lab::Disagreement> disagreements_of(const std::vector<IntegralRun>& runs) {
  std::vector<lab::NamedEstimate> estimates;
  for (const IntegralRun& run : runs) estimates.push_back(lab::estimate_named(run.method, run.result.state));
  return lab::disagreements_of(estimates);
}

bool has_warnings(const std::vector<IntegralRun>& runs) {
  const auto warned = [](const IntegralRun& run) { return !run.result.warnings.empty(); };
  return std::ranges::any_of(runs, warned) || !disagreements_of(runs).empty();
}

std::vector<IntegralRun> runs_of(const SavedIntegral& saved) {
  std::vector<IntegralRun> runs;
  for (std::size_t k = 0; k < saved.states.size(); ++k)
    runs.push_back({saved.methods[k], lab::result_of(saved.states[k], saved.options.budget.confidence)});
  return runs;
}

std::optional<lab::Budget> rest_of_budget(const SavedIntegral& saved) {
  lab::Budget rest = saved.options.budget;
  if (saved.states.size() < saved.options.methods.size()) return rest;
  std::uint64_t samples = 0;
  double seconds = 0;
  for (const lab::IntegralState& state : saved.states) {
    samples = std::max(samples, state.evaluations);
    seconds = std::max(seconds, state.seconds);
  }
  if (rest.samples) {
    if (*rest.samples < samples + 2) return std::nullopt;
    *rest.samples -= samples;
  }
  if (rest.seconds) {
    if (*rest.seconds <= seconds) return std::nullopt;
    *rest.seconds -= seconds;
  }
  return rest;
}

}  // namespace montelux
