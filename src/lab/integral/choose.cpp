#include "lab/integral/choose.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "lab/integral/singularity.h"
#include "lab/integral/summary.h"
#include "lab/integral/technique.h"

namespace montelux::lab {
namespace {

constexpr std::uint32_t passes = 8;
constexpr std::uint32_t first_pilot_pass = 0x80000000u;  // larger than all pass numbers of a run
constexpr double pilot_share = 0.03;
// A map that divides the variance of a sample by at least `clear_gain` is used without a trial; one below `no_gain` is
// not used.
constexpr double clear_gain = 4, no_gain = 1.5;
constexpr std::uint64_t min_samples_to_try = 32768;
constexpr int first_steps = 5;
constexpr std::uint64_t max_samples_to_probe = 1u << 20;
constexpr std::uint64_t max_samples_to_plan = 1u << 26;  // longer pilots are not needed for more samples

// One candidate: its passes grow as long as it can still win.
struct Pilot {
  Method method;
  double weight = 1;  // cost of a sample in evaluations, including overhead
  double bonus = 0;   // subtracted from the logarithm of the variance: for a rate that pilots are too short to show
  std::unique_ptr<Technique> technique;
  std::vector<TermSums> sums = std::vector<TermSums>(passes);
  std::uint64_t length = 0;
  std::vector<double> variances;  // of the mean of passes, at doubling lengths
  double predicted = 0;           // logarithm of the variance times the cost, at the full budget

  void grow(std::uint64_t seed, std::uint64_t to) {
    const std::uint64_t count = to - length;
    Moments means;
    for (std::uint32_t p = 0; p < passes; ++p) {
      sums[p].merge(technique->run({CubeKey::of(seed, first_pilot_pass + p), length, count, length, count}));
      means.add(sums[p].sum / double(sums[p].samples));
    }
    length = to;
    variances.push_back(means.variance() + 1e-32 * means.mean * means.mean);
  }
  // Its estimate, if it can be compared with others: enough terms, and none that dominates.
  std::optional<NamedEstimate> estimate() const {
    constexpr std::uint64_t enough = 1024;
    IntegralState state;
    state.method = method;
    double n = 0, sum = 0, m2 = 0;
    for (const TermSums& s : sums) {
      state.passes.push_back({0, std::uint32_t(state.passes.size()), s.samples, s.sum, s.m2});
      state.largest.merge(s.largest);
      n += double(s.samples), sum += s.sum, m2 += s.m2;
    }
    const bool varies = method.kind == MethodKind::control;  // the sums of passes differ from those of the estimate
    if (varies || n < double(enough) || found_nothing(state) || diagnose_tail(state, m2, sum / n, n).heavy)
      return std::nullopt;
    return estimate_named("the pilot of " + to_text(method), state);
  }
  std::uint64_t evaluations() const {
    std::uint64_t n = 0;
    for (const TermSums& s : sums) n += s.evaluations;
    return n;
  }
  // The variance with `full` samples per pass. Its decline per doubling is a mean of the observed and the usual one.
  void predict(double full) {
    constexpr double usual = 2.2, slowest = 1, fastest = 4;
    double decline = usual;
    if (variances.size() > 1) {
      const double seen = std::log2(variances.front() / variances.back()) / double(variances.size() - 1);
      const double doublings = double(variances.size() - 1);
      decline = (usual * 1.5 + std::clamp(seen, slowest, fastest) * doublings) / (1.5 + doublings);
    }
    if (method.kind != MethodKind::qmc) decline = 1;  // independent samples
    const double ratio = std::max(1.0, full / double(length) / weight);
    predicted = std::log(variances.back()) - decline * std::log(ratio) - bonus;
  }
};

Method qmc(PointSetKind points, bool baker, bool adapt) {
  Method m;
  m.kind = MethodKind::qmc, m.points = points, m.baker = baker, m.adapt = adapt;
  return m;
}

// Whether a run too short for trials uses the map. In few dimensions little training suffices, and not using a good map
// costs more than using a useless one; in many dimensions the first steps fit noise.
bool maps_without_trial(double gain, std::size_t dimension) { return gain >= (dimension <= 6 ? 1.25 : 3); }

// The points that are usually best: lattices in few dimensions, in more of them without a map.
Method by_rule(std::size_t dimension, bool adapt) {
  return dimension <= (adapt ? 3 : 6) ? qmc(PointSetKind::lattice, true, adapt)
                                      : qmc(PointSetKind::sobol, false, adapt);
}

Method other_points(const Method& m) {
  return m.points == PointSetKind::lattice ? qmc(PointSetKind::sobol, false, m.adapt)
                                           : qmc(PointSetKind::lattice, true, m.adapt);
}

// The methods that may win, given the gain of the map so far.
std::vector<Method> plausible(const Problem& problem, std::uint64_t samples, double gain) {
  const std::size_t dimension = problem.integrand.dimension;
  std::vector<Method> methods;
  if (samples < min_samples_to_try) {
    methods.push_back(by_rule(dimension, maps_without_trial(gain, dimension)));
  } else {
    if (gain >= no_gain) methods.push_back(by_rule(dimension, true));
    if (gain < clear_gain) {
      methods.push_back(by_rule(dimension, false));
      if (dimension > 3) methods.push_back(other_points(methods.back()));
    }
  }
  Method given;
  given.kind = MethodKind::control;
  if (problem.control) methods.push_back(given);
  given.kind = problem.densities.size() > 1 ? MethodKind::mis : MethodKind::importance;
  if (!problem.densities.empty()) methods.push_back(given);
  return methods;
}

// Lattices with a periodic integrand gain more from more points than nets do, mostly in few dimensions; pilots are
// too short to show it.
double lattice_bonus(std::size_t dimension, bool mapped) {
  if (dimension > 6) return -1;
  return mapped ? 0.5 : 3;
}

std::string explain(const std::vector<Pilot>& pilots, const Pilot& best, double gain) {
  std::string text = gain == 1 ? "an adaptive map finds nothing to adapt to; "
                               : fmt::format("an adaptive map divides the variance of a sample by {:.2g}; ", gain);
  if (pilots.size() < 2) return text + fmt::format("{} is usually best", to_text(best.method));
  std::vector<std::string> items;
  for (const Pilot& p : pilots)
    items.push_back(
        fmt::format("{} {:.2g}", to_text(p.method), std::exp(0.5 * p.predicted) / std::sqrt(double(passes))));
  return text + fmt::format("pilots of up to {} samples predict the standard errors {} at equal cost",
                            best.length * passes, fmt::join(items, ", "));
}

Choice choose_by_pilots(const Problem& problem, std::uint64_t seed, std::uint64_t samples, MapTraining& training) {
  training.go_to(first_steps);
  const double gain = training.gain();
  const std::vector<Method> methods = plausible(problem, samples, gain);
  // If only mapped methods remain, they are tried with their final map.
  if (std::all_of(methods.begin(), methods.end(), trains)) training.go_to(MapTraining::steps);
  std::vector<Pilot> pilots;
  for (const Method& method : methods) {
    Pilot p;
    p.method = method, p.weight = trains(method) ? 1.2 : method.kind == MethodKind::qmc ? 1 : 2;
    if (method.points == PointSetKind::lattice) p.bonus = lattice_bonus(problem.integrand.dimension, trains(method));
    p.technique = make_technique(problem, method, seed, &training);
    pilots.push_back(std::move(p));
  }
  if (pilots.size() == 1) return {methods.front(), explain(pilots, pilots.front(), gain)};
  const double budget = pilot_share * double(std::min(samples, max_samples_to_plan)), full = double(samples) / passes;
  const std::uint64_t first =
      std::bit_floor(std::max<std::uint64_t>(64, std::uint64_t(0.4 * budget) / (passes * pilots.size())));
  double spent = 0;
  const auto grow = [&](Pilot& p, std::uint64_t to) {
    spent += double((to - p.length) * passes) * p.technique->traits().cost;
    p.grow(seed, to);
    p.predict(full);
  };
  for (Pilot& p : pilots) {
    grow(p, first / 4), grow(p, first / 2), grow(p, first);
  }

  // Those that can still win get twice the samples, as long as the budget of the pilots suffices.
  const auto lowest = [&] {
    return std::min_element(pilots.begin(), pilots.end(),
                            [](const Pilot& a, const Pilot& b) { return a.predicted < b.predicted; });
  };
  constexpr double hopeless = 2.5;  // in the logarithm of the predicted variance
  for (std::uint64_t to = 2 * first;; to *= 2) {
    const double limit = lowest()->predicted + hopeless;
    std::vector<Pilot*> alive;
    for (Pilot& p : pilots)
      if (p.predicted <= limit && p.length == to / 2) alive.push_back(&p);
    if (alive.size() < 2 || spent + double(to / 2 * passes * alive.size()) > budget) break;
    for (Pilot* p : alive) grow(*p, to);
  }
  const Pilot& best = *lowest();
  Choice choice{best.method, explain(pilots, best, gain)};
  for (const Pilot& p : pilots) {
    choice.evaluations += p.evaluations();
    if (auto estimate = p.estimate()) choice.pilots.push_back(std::move(*estimate));
  }
  return choice;
}

}  // namespace

Choice choose_method(const Problem& problem, std::uint64_t seed, std::uint64_t samples, MapTraining& training) {
  // Too few samples to train a map.
  const bool too_few = samples <= 16 * problem.integrand.dimension * problem.integrand.dimension && !problem.control &&
                       problem.densities.empty();
  if (too_few) return {qmc(PointSetKind::sobol, false, false), "there are too few samples for pilots"};
  // The error of quasi-Monte Carlo points depends on the distance of the closest one to a singularity; boxes with many
  // independent samples each are better there.
  const TailProbe probe = probe_tail(problem.integrand, seed, std::min(samples, max_samples_to_probe) / 32);
  if (probe.exponent > 0 && problem.densities.empty() && !problem.control) {
    Method vegas;
    vegas.kind = MethodKind::vegas;
    return {vegas,
            fmt::format("the integrand grows without bound, like the distance to the power {:.2g}", -probe.exponent),
            probe.evaluations,
            {},
            probe};
  }
  Choice choice = choose_by_pilots(problem, seed, samples, training);
  choice.probe = probe, choice.evaluations += probe.evaluations;
  return choice;
}

}  // namespace montelux::lab
