#include "lab/integral/integrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "lab/integral/choose.h"
#include "lab/integral/density_sampler.h"
#include "lab/integral/sampled.h"
#include "lab/integral/schedule.h"
#include "lab/integral/singularity.h"
#include "lab/integral/summary.h"
#include "lab/integral/technique.h"
#include "mc/sobol.h"

namespace montelux::lab {
namespace {

void check(const Problem& problem, const Budget& budget) {
  const auto fail = [](std::string message) { throw std::invalid_argument(std::move(message)); };
  if (!problem.integrand.evaluate) fail("there is no integrand");
  if (problem.integrand.dimension < 1 || problem.integrand.dimension > 64)
    fail(fmt::format("an integrand has 1 to 64 dimensions, not {}", problem.integrand.dimension));
  if (budget.samples && *budget.samples < 2) fail("at least two samples are needed");
  if (budget.seconds && !(*budget.seconds > 0)) fail("the time must be positive");
  if (budget.target_error && !(*budget.target_error > 0)) fail("the target error must be positive");
  if (!(budget.confidence > 0 && budget.confidence < 1)) fail("the confidence must be between 0 and 1");
}

// The expected number of samples of the run, as far as it is known in advance.
std::uint64_t planned_samples(const Budget& budget) {
  constexpr std::uint64_t unknown = 1u << 16;
  if (budget.samples) return *budget.samples;
  if (budget.target_error) return unknown;
  return budget.seconds ? std::uint64_t(std::clamp(1e6 * *budget.seconds, 1e5, 1e8)) : default_samples;
}

// A share of the samples small enough to cost little if it is useless, and no more than a map can use.
std::uint64_t training_plan(std::uint64_t samples) {
  constexpr std::uint64_t min_samples = 128, max_samples = 1u << 16;
  return std::clamp<std::uint64_t>(samples / 6, min_samples, max_samples);
}

// The state of a run before its first pass.
struct Start {
  IntegralState state;
  std::unique_ptr<Technique> technique;
  std::string why;                    // of the choice of `auto`
  std::vector<NamedEstimate> pilots;  // of `auto`
};
Start begin(const Problem& problem, const Method& method, const Budget& budget, const Execution& execution) {
  Start start;
  IntegralState& state = start.state;
  const bool resumed = execution.resume.has_value();
  if (resumed) {
    state = *execution.resume;
    if (state.dimension != problem.integrand.dimension)
      throw std::invalid_argument(fmt::format("the state is of an integral in {} dimensions, this one has {}",
                                              state.dimension, problem.integrand.dimension));
  } else {
    state.method = method, state.dimension = problem.integrand.dimension, state.seed = execution.seed;
    const bool may_train = method.kind == MethodKind::automatic || trains(method);
    if (may_train) state.training_samples = training_plan(planned_samples(budget));
  }
  MapTraining training(problem.integrand, state.seed, state.training_samples);
  if (state.method.kind == MethodKind::automatic) {
    const Choice choice = choose_method(problem, state.seed, planned_samples(budget), training);
    state.method = choice.method, state.training_evaluations = choice.evaluations, state.probe = choice.probe;
    start.why = choice.why, start.pilots = choice.pilots;
    if (!trains(state.method)) state.training_evaluations += training.evaluations();
  }
  if (trains(state.method)) training.go_to(MapTraining::steps);
  start.technique = make_technique(problem, state.method, state.seed, &training);
  if (!resumed) {
    state.training_evaluations += start.technique->traits().training_evaluations;
    state.evaluations = state.training_evaluations;
  }
  return start;
}

// The part of the integral where the sampling density is 0: the resulting bias.
struct MissedRegion {
  double integral = 0, standard_error = 0;
  std::uint64_t points = 0;  // uniform points that found it
};
constexpr std::uint64_t missed_samples = 4096;

// The maximum cost of probing the tail.
std::uint64_t probe_budget(std::uint64_t samples) { return std::min<std::uint64_t>(samples / 16, 1u << 15); }

// After the run, if the terms may have a heavy tail and the integrand was not probed.
void probe_if_needed(const Problem& problem, IntegralState& state) {
  constexpr double suspicious = 10, share = 0.05;
  if (state.probe.known || !needs_probe(state.method)) return;
  const TailDiagnosis tail = result_of(state).tail;
  if (tail.hill_index > suspicious && tail.largest_share < share) return;
  state.probe = probe_tail(problem.integrand, state.seed, probe_budget(state.evaluations));
  state.training_evaluations += state.probe.evaluations, state.evaluations += state.probe.evaluations;
}

MissedRegion measure_missed(const Integrand& integrand, const BatchFunction& support, std::uint64_t seed,
                            std::uint64_t samples) {
  const std::size_t dimension = integrand.dimension, capacity = batch_size(dimension);
  std::vector<double> points(dimension * capacity), p(capacity), f(capacity);
  MissedRegion region;
  Moments moments;
  for (std::uint64_t done = 0; done < samples;) {
    const std::size_t n = std::size_t(std::min<std::uint64_t>(capacity, samples - done));
    const PointBatch batch{std::span(points).first(dimension * n), dimension, n};
    fill_independent(CubeKey::of(seed, ~0u).fork(0xdec1a7edu), {dimension, done, n, points.data()});
    support(batch, std::span(p).first(n));
    integrand.evaluate(batch, std::span(f).first(n));
    for (std::size_t i = 0; i < n; ++i) {
      const bool missed = p[i] == 0 && f[i] != 0;
      region.points += missed ? 1 : 0;
      moments.add(missed ? f[i] : 0);
    }
    done += n;
  }
  region.integral = moments.mean, region.standard_error = moments.standard_error();
  return region;
}

IntegralWarning warning_of(const MissedRegion& region) {
  return {IntegralWarning::Kind::missed_region,
          fmt::format("the integrand is not 0 where its sampling density is: the result misses about {:.3g} +- {:.1g}",
                      region.integral, region.standard_error)};
}

}  // namespace

std::string_view name_of(StopReason reason) {
  switch (reason) {
    case StopReason::samples:
      return "samples";
    case StopReason::seconds:
      return "seconds";
    case StopReason::target_error:
      return "target-error";
    case StopReason::nothing_found:
      return "nothing-found";
    case StopReason::rounding:
      return "rounding";
    case StopReason::stopped:
      break;
  }
  return "stopped";
}

IntegralResult integrate(const Problem& problem, const Method& method, const Budget& budget,
                         const Execution& execution) {
  const auto start = std::chrono::steady_clock::now();
  check(problem, budget);
  auto [state, technique, why, pilots] = begin(problem, method, budget, execution);
  std::vector<IntegralWarning> missed;
  if (const BatchFunction support = technique->support()) {
    const MissedRegion region = measure_missed(problem.integrand, support, state.seed, missed_samples);
    if (!execution.resume) state.training_evaluations += missed_samples, state.evaluations += missed_samples;
    if (region.points > 0) missed.push_back(warning_of(region));
  }
  Schedule schedule(*technique, budget, execution, state, start);
  const StopReason reason = schedule.run();
  probe_if_needed(problem, state);
  IntegralResult result = result_of(state, budget.confidence);
  for (IntegralWarning& w : missed) result.warnings.push_back(std::move(w));
  if (!pilots.empty()) {
    pilots.push_back(estimate_named(to_text(state.method), state));
    for (const Disagreement& d : disagreements_of(pilots))
      result.warnings.push_back({IntegralWarning::Kind::disagreement, to_text(d)});
  }
  result.stopped_because = reason;
  result.why = why;
  result.target_reached = schedule.target_reached();
  if (budget.target_error && !result.found_nothing) {
    const double reach = estimate_of(state).reach(schedule.confidence());
    result.interval = {result.mean - reach, result.mean + reach};
    if (!result.target_reached)
      result.warnings.push_back(
          {IntegralWarning::Kind::target,
           fmt::format("the budget ended before the target error: half the interval is {:.3g}", reach)});
  }
  return result;
}

bool DensityReport::normalised() const { return std::abs(integral - 1) <= std::max(1e-4, 5 * standard_error); }

DensityReport inspect_density(const Problem& problem, std::size_t which, std::uint64_t samples, std::uint64_t seed) {
  const UserDensity& density = problem.densities.at(which);
  const std::size_t dimension = problem.integrand.dimension, batch = batch_size(dimension);
  constexpr std::uint32_t passes = 16;
  DensityReport report;
  Moments over_passes;
  std::vector<double> points(dimension * batch), p(batch);
  const std::uint64_t length = std::bit_ceil(std::max<std::uint64_t>(samples / passes, batch));
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    Moments inside;
    for (std::uint64_t done = 0; done < length;) {
      const std::size_t n = std::size_t(std::min<std::uint64_t>(batch, length - done));
      fill_sobol(CubeKey::of(seed, ~0u).fork(pass), {dimension, done, n, points.data()});
      density.density({std::span(points).first(dimension * n), dimension, n}, std::span(p).first(n));
      for (std::size_t i = 0; i < n; ++i) {
        inside.add(p[i] * density.scale);
        report.negative |= p[i] < 0;
      }
      done += n;
    }
    over_passes.add(inside.mean);
    report.non_finite += inside.non_finite;
  }
  report.integral = over_passes.mean, report.standard_error = over_passes.standard_error();
  const MissedRegion region = measure_missed(problem.integrand, density.density, seed, samples);
  report.missed = region.integral, report.missed_error = region.standard_error;
  if (!report.negative && report.non_finite == 0 && report.integral > 0) {
    const DensitySampler sampler(density, dimension);
    if (sampler.sampling() == DensitySampling::rejection)
      report.acceptance = report.integral / (sampler.bound() * density.scale);
  }
  return report;
}

}  // namespace montelux::lab
