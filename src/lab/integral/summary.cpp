#include "lab/integral/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/integral/diagnosis.h"
#include "mc/weighted_mean.h"

namespace montelux::lab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The means of the passes, less the control variate with the coefficient given or fitted on all the other passes: what
// is fitted elsewhere is independent of the pass and so leaves it unbiased.
struct PassMeans {
  std::vector<double> means;
  std::optional<double> coefficient;
};
PassMeans pass_means(const IntegralState& state) {
  PassMeans result;
  double squares = 0, products = 0, controls = 0, sums = 0, n = 0;
  for (const PassRecord& p : state.passes) {
    result.means.push_back(p.mean());
    squares += p.control_squares, products += p.control_products, controls += p.control_sum, sums += p.sum;
    n += double(p.samples);
  }
  // A defensive mixture (Hesterberg 1995; Owen and Zhou 2000): where the map missed a part, the uniform points'
  // estimate of it takes the place of the map's.
  if (const auto outside = outside_map_of(state); outside && outside->missed)
    for (std::size_t i = 0; i < state.passes.size(); ++i) {
      const PassRecord& p = state.passes[i];
      result.means[i] += (p.outside.uniform - p.outside.map) / double(p.samples);
    }
  if (state.method.kind != MethodKind::control) return result;
  double total = 0;
  for (std::size_t i = 0; i < state.passes.size(); ++i) {
    const PassRecord& p = state.passes[i];
    const double rest = n - double(p.samples);
    const double c = controls - p.control_sum, s = sums - p.sum;
    const double variance = squares - p.control_squares - (rest > 0 ? c * c / rest : 0);
    const double covariance = products - p.control_products - (rest > 0 ? c * s / rest : 0);
    const double fitted = variance > 0 ? covariance / variance : 0;
    const auto& stated = state.method.coefficient;
    const double coefficient = stated ? double(*stated) : fitted;
    if (p.samples > 0) result.means[i] -= coefficient * p.control_sum / double(p.samples);
    total += coefficient;
  }
  if (!state.passes.empty()) result.coefficient = total / double(state.passes.size());
  return result;
}

}  // namespace

double PassEstimate::reach(double confidence) const {
  if (!(degrees > 0)) return infinity;
  return special::student_t_quantile(0.5 + 0.5 * confidence, degrees) * standard_error;
}

double confidence_of_look(double confidence, int look) { return 1 - (1 - confidence) / (double(look) * (look + 1)); }

PassEstimate estimate_of(const IntegralState& state) {
  const PassMeans values = pass_means(state);
  PassEstimate e;
  e.coefficient = values.coefficient;
  const WeightedMean m = weighted_mean(
      values.means.size(), [&](std::size_t i) { return double(state.passes[i].samples); },
      [&](std::size_t i) { return values.means[i]; });
  e.mean = m.mean, e.degrees = m.degrees, e.standard_error = m.standard_error;
  if (!(e.degrees > 0)) return e;
  // What sums of doubles leave of terms that are all alike.
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(e.mean);
  e.spread = e.standard_error > rounding;
  e.standard_error = std::max(e.standard_error, rounding);
  return e;
}

bool found_nothing(const IntegralState& state) { return !state.passes.empty() && !(state.largest.max() > 0); }

IntegralResult result_of(const IntegralState& state, double confidence) {
  const PassEstimate e = estimate_of(state);
  IntegralResult r;
  r.mean = e.mean, r.standard_error = e.standard_error, r.confidence = confidence;
  r.found_nothing = found_nothing(state);
  if (r.found_nothing) r.standard_error = infinity;
  const double reach = r.found_nothing ? infinity : e.reach(confidence);
  r.interval = {e.mean - reach, e.mean + reach};
  r.evaluations = state.evaluations, r.training_evaluations = state.training_evaluations;
  r.seconds = state.seconds, r.passes = state.passes.size(), r.non_finite = state.non_finite;
  const double cost = r.standard_error * r.standard_error * r.seconds;
  r.efficiency = cost > 0 && std::isfinite(cost) ? 1 / cost : 0;
  r.coefficient = e.coefficient;
  if (state.proposed > 0) r.acceptance = double(state.accepted) / double(state.proposed);

  // The variance of a term about the common mean, and of the pass means by it: what independent terms would have.
  double samples = 0, inside = 0, among = 0, sum = 0;
  for (const PassRecord& p : state.passes) samples += double(p.samples), inside += p.m2, sum += p.sum;
  const double mean = samples > 0 ? sum / samples : 0;
  for (const PassRecord& p : state.passes) among += double(p.samples) * (p.mean() - mean) * (p.mean() - mean);
  const double dof_inside = samples - double(r.passes), dof_among = double(r.passes) - 1;
  if (samples > 1) r.variance_of_one_sample = (inside + among) / (samples - 1);
  if (dof_among > 0) {
    // By the variance that the passes state of themselves, taken together; else by that of independent terms.
    double own = 0, chi2 = 0;
    for (const PassRecord& p : state.passes)
      own += p.samples > 0 ? p.own_variance / double(p.samples) / double(r.passes) : 0;
    const double of_sample = own > 0 ? own : dof_inside > 0 ? inside / dof_inside : 0;
    if (of_sample > 0 && e.spread) chi2 = among / of_sample;
    r.chi2_per_dof = chi2 / dof_among;
    r.q = special::chi_square_tail(chi2, dof_among);
  }
  r.tail = diagnose_tail(state, inside + among, mean, samples);
  r.outside_map = outside_map_of(state);
  double magnitude = 0;
  for (const PassRecord& p : state.passes) magnitude += p.magnitude;
  const double squares = inside + among + samples * mean * mean;
  if (r.outside_map && squares > 0) r.map_worth = std::min(1.0, magnitude * magnitude / (samples * squares));
  r.method = state.method;
  r.state = state;
  r.warnings = warnings_of(r);
  return r;
}

}  // namespace montelux::lab
