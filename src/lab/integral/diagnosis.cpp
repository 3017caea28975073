#include "lab/integral/diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lab/integral/summary.h"
#include "mc/weighted_mean.h"

namespace montelux::lab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// A share of the integral outside the map that is worth a warning.
constexpr double notable_share = 1e-3;
// A single term with this share of the variance makes the error bar unreliable.
constexpr double dominant_share = 0.1;
// For unbounded terms that are known to have a variance, the largest often has a large share.
constexpr double dominant_share_of_singular = 0.5;

// The mean of values over passes, weighted by their samples.
template <class Value>
WeightedMean over_passes(const std::vector<PassRecord>& passes, Value value) {
  return weighted_mean(
      passes.size(), [&](std::size_t i) { return double(passes[i].samples); },
      [&](std::size_t i) { return value(passes[i]); });
}

double two_sided_p(double mean, double standard_error, double degrees) {
  if (!(standard_error > 0)) return mean == 0 ? 1 : 0;
  return 2 * special::student_t_cdf(-std::abs(mean) / standard_error, degrees);
}

// The expected sum of the control variate minus its integral is 0.
bool contradicts_control(const IntegralState& state) {
  if (state.method.kind != MethodKind::control) return false;
  const WeightedMean m =
      over_passes(state.passes, [](const PassRecord& p) { return p.control_sum / double(p.samples); });
  double n = 0, squares = 0;
  for (const PassRecord& p : state.passes) n += double(p.samples), squares += p.control_squares;
  const bool rounding = std::abs(m.mean) <= 1e-12 * std::sqrt(squares / std::max(1.0, n));
  return m.degrees > 0 && !rounding && two_sided_p(m.mean, m.standard_error, m.degrees) < control_level;
}

std::string tail_text(const TailDiagnosis& tail) {
  const std::string share = fmt::format("the largest term makes {:.2g} % of the variance", 100 * tail.largest_share);
  if (tail.fitted_terms == 0) return share;
  return fmt::format("tail index {:.3g} +- {:.1g} by the {} largest terms; {}", tail.hill_index,
                     tail.hill_index / std::sqrt(double(tail.fitted_terms)), tail.fitted_terms, share);
}

}  // namespace

TailDiagnosis diagnose_tail(const IntegralState& state, double m2, double mean, double samples) {
  TailDiagnosis tail;
  const std::vector<double> largest = state.largest.sorted();
  tail.hill_index = infinity;
  if (largest.empty() || !(samples > 1)) return tail;
  // Terms that differ only by rounding have no tail.
  if (!(std::sqrt(m2 / samples) > 1e-13 * largest.front())) return tail;
  const double distance = largest.front() - std::abs(mean);
  tail.largest_share = std::min(1.0, distance * distance / m2);
  const TailFit fit = fit_tail(largest, std::uint64_t(samples));
  tail.hill_index = fit.index, tail.fitted_terms = fit.terms;
  if (state.probe.known && needs_probe(state.method)) {
    // The index of a singularity is known to a few percent, and that of a bounded integrand is infinite.
    const TailProbe& probe = state.probe;
    const double share = probe.exponent > 0 ? dominant_share_of_singular : dominant_share;
    tail.hill_index = probe.index, tail.fitted_terms = probe.terms;
    tail.heavy = probe.index <= 2.04 || tail.largest_share > share;
    tail.may_not_exist = probe.index <= 1.02;
    return tail;
  }
  // A tail counts only if it is seen in many samples.
  constexpr double counts = 0.01;
  const bool infinite_variance = fit.lower_bound() <= 2 && tail.largest_share > counts;
  tail.heavy = infinite_variance || (samples >= 100 && tail.largest_share > dominant_share);
  tail.may_not_exist = fit.lower_bound() <= 1 && tail.heavy;
  return tail;
}

bool needs_probe(const Method& method) {
  using enum MethodKind;
  const std::array kinds{uniform, stratified, antithetic, control, qmc, vegas, miser};
  return std::ranges::find(kinds, method.kind) != kinds.end();
}

std::optional<OutsideMap> outside_map_of(const IntegralState& state) {
  const auto mean_of = [&](auto sum) {
    return over_passes(state.passes, [&](const PassRecord& p) { return sum(p) / double(p.samples); });
  };
  if (state.method.kind != MethodKind::qmc || !state.method.adapt) return std::nullopt;
  const WeightedMean uniform = mean_of([](const PassRecord& p) { return p.outside.uniform; });
  const WeightedMean map = mean_of([](const PassRecord& p) { return p.outside.map; });
  const WeightedMean difference = mean_of([](const PassRecord& p) { return p.outside.uniform - p.outside.map; });
  if (!(uniform.degrees > 0)) return std::nullopt;
  OutsideSums all;
  for (const PassRecord& p : state.passes) all.merge(p.outside);
  // Two tests at half the level each. Student's detects what many points find. Markov's inequality holds for a single
  // hit: if the expectation of the magnitude is that of the map, it is exceeded k times with probability at most 1 / k.
  constexpr double level = outside_map_level / 2;
  const bool many = two_sided_p(difference.mean, difference.standard_error, difference.degrees) < level;
  const bool few = all.map_magnitude < level * all.uniform_magnitude;
  OutsideMap o{uniform.mean, uniform.standard_error, map.mean, map.standard_error, false};
  o.missed = all.uniform_magnitude > all.map_magnitude && (many || few);
  return o;
}

std::vector<IntegralWarning> warnings_of(const IntegralResult& r) {
  std::vector<IntegralWarning> warnings;
  const auto warn = [&](IntegralWarning::Kind kind, std::string message) {
    warnings.push_back({kind, std::move(message)});
  };
  using enum IntegralWarning::Kind;
  if (r.non_finite > 0)
    warn(non_finite, fmt::format("{} of {} values are not finite and count as 0: the result is not reliable",
                                 r.non_finite, r.evaluations));
  if (r.found_nothing)
    warn(nothing_found,
         fmt::format("no sample found anything: all of {} values are 0, and the error is unknown", r.evaluations));
  if (r.tail.may_not_exist)
    warn(may_not_exist, fmt::format("the integral may not exist ({})", tail_text(r.tail)));
  else if (r.tail.heavy)
    warn(heavy_tail, fmt::format("the terms have a heavy tail ({}): the error bar is not reliable", tail_text(r.tail)));
  if (const auto& o = r.outside_map;
      o && o->missed && std::abs(o->by_uniform - o->by_map) > notable_share * std::abs(r.mean))
    warn(outside_map,
         fmt::format("uniform points find {:.3g} +- {:.1g} of the integral outside the adaptive map, which finds "
                     "{:.3g} there: the value includes it, other parts may be missed",
                     o->by_uniform, o->uniform_error, o->by_map));
  if (r.map_worth && *r.map_worth < doubtful_map_worth)
    warn(map_fit,
         fmt::format(
             "the adaptive map fits the integrand badly: a sample is worth {:.2g} of one that follows it. The map "
             "adapts each axis alone, which separate peaks and slanted ridges defeat; a peak that no sample met "
             "is missing",
             *r.map_worth));
  if (contradicts_control(r.state))
    warn(control_integral, "the samples of the control variate contradict its stated integral: the result is biased");
  if (r.passes < 5) warn(few_passes, fmt::format("{} passes are few for an error bar", r.passes));
  if (r.q < 1e-6)
    warn(inconsistent,
         fmt::format("the passes spread more than their samples do (chi2/dof {:.3g}, Q {:.2g})", r.chi2_per_dof, r.q));
  return warnings;
}

NamedEstimate estimate_named(std::string name, const IntegralState& state) {
  const PassEstimate e = estimate_of(state);
  return {std::move(name), e.mean, found_nothing(state) ? infinity : e.standard_error, e.degrees};
}

std::vector<Disagreement> disagreements_of(std::span<const NamedEstimate> estimates, double level) {
  std::vector<Disagreement> found;
  const double n = double(estimates.size()), pairs = 0.5 * n * (n - 1);
  const auto reach = [&](const NamedEstimate& e) {
    return e.degrees > 0 ? special::student_t_quantile(1 - 0.25 * level / pairs, e.degrees) * e.standard_error
                         : infinity;
  };
  for (std::size_t i = 0; i < estimates.size(); ++i)
    for (std::size_t j = i + 1; j < estimates.size(); ++j) {
      const NamedEstimate &a = estimates[i], &b = estimates[j];
      const double distance = std::abs(a.mean - b.mean);
      const bool rounding = distance <= 1e-12 * std::max(std::abs(a.mean), std::abs(b.mean));
      if (distance > reach(a) + reach(b) && !rounding)
        found.push_back({a.name, b.name, a.mean - b.mean, std::hypot(a.standard_error, b.standard_error)});
    }
  return found;
}

std::string to_text(const Disagreement& d) {
  return fmt::format("{} and {} disagree: they differ by {:.3g}, {:.3g} of its standard errors; at least one is wrong",
                     d.first, d.second, d.difference, std::abs(d.difference) / d.standard_error);
}

}  // namespace montelux::lab
