// R: combining reservoirs of neighbours that do not see the same domain.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/resampling.h"

namespace montelux::lab {

namespace {

double f(double x) { return 4 * x * x * x; }
double own_target(double x) { return x * x; }
// The neighbour sees only the first half; there the integral of f is 1/16.
double neighbour_target(double x) { return x < 0.5 ? x * x : 0; }
constexpr double neighbour_part = 1.0 / 16;

struct Chosen {
  double y = 0, weight = 0;  // weight: estimates the inverse density
};

Chosen choose(double (*target)(double), std::uint32_t candidates, RandomStream<float>& stream) {
  WeightedReservoir<double> reservoir;
  for (std::uint32_t i = 0; i < candidates; ++i) {
    const double x = double(stream.next());
    reservoir.add(x, float(target(x)), stream.next());
  }
  return {reservoir.value,
          double(resampling_weight(reservoir.weight_sum, reservoir.count, float(target(reservoir.value))))};
}

enum class Combination { naive, counted, balance };

// The two choices are resampled for the own target; the combinations differ in how their weights are shared.
double combine(Combination combination, std::uint32_t own, std::uint32_t others, RandomStream<float>& stream) {
  const std::array<Chosen, 2> chosen{choose(own_target, own, stream), choose(neighbour_target, others, stream)};
  const std::array<double, 2> counts{double(own), double(others)};
  const auto share = [&](std::size_t k) {
    const double y = chosen[k].y, a = counts[0] * own_target(y), b = counts[1] * neighbour_target(y);
    return combination != Combination::balance ? counts[k] : a + b > 0 ? (k == 0 ? a : b) / (a + b) : 0;
  };
  WeightedReservoir<std::size_t> merged;
  for (std::size_t k = 0; k < 2; ++k)
    merged.add(k, float(share(k) * own_target(chosen[k].y) * chosen[k].weight), stream.next());
  const double y = chosen[merged.value].y;
  const double weight = own_target(y) > 0 ? double(merged.weight_sum) / own_target(y) : 0;
  switch (combination) {
    case Combination::naive:
      return f(y) * weight / (own + others);
    case Combination::counted:
      return f(y) * weight / (own + (neighbour_target(y) > 0 ? others : 0));
    case Combination::balance:
      return f(y) * weight;
  }
  return 0;
}

Findings run(const Setup& setup) {
  const std::uint32_t many = setup.count("realisations"), own = setup.count("candidates");
  constexpr std::array<const char*, 3> names{"divided by all candidates", "divided by those that could have made it",
                                             "balance heuristic"};
  Figure figure{"bias",
                "Mean of the combined estimate against the neighbour's candidates. The true value is 1; the naive "
                "combination goes for the neighbour's $\\int f = 1/16$.",
                {"candidates of the neighbour", true, {}, {}},
                {"mean", false, {}, {}},
                {},
                false};
  Table table{"variance",
              "With as many candidates of the neighbour as of one's own.",
              {"combination", "mean", "expected", "variance"},
              {}};
  Findings findings;
  std::uint32_t purpose = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    // The planted fault takes the naive combination for the cure.
    const Combination combination = setup.fault() && c == 1 ? Combination::naive : Combination(c);
    Curve curve{names[c], Mark::points, {}, {}, {}, {}};
    std::vector<double> z_truth, z_naive;
    for (std::uint32_t others = 1; others <= 16 * own; others *= 2) {
      const Spread s = spread_of(realisations(setup, purpose++, many,
                                              [&](auto& stream) { return combine(combination, own, others, stream); }));
      const double naive = (own + others * neighbour_part) / (own + others);
      curve.x.push_back(others), curve.y.push_back(s.mean);
      curve.low.push_back(s.mean - s.mean_error), curve.high.push_back(s.mean + s.mean_error);
      z_truth.push_back((s.mean - 1) / s.mean_error), z_naive.push_back((s.mean - naive) / s.mean_error);
      if (others == own)
        table.rows.push_back({names[c], with_error(s.mean, s.mean_error), c == 0 ? naive : 1.0,
                              with_error(s.variance, s.variance_error)});
    }
    figure.curves.push_back(curve);
    if (c == 0) {
      findings.checks.push_back(
          rejected(deviations_check("Divided by all candidates, the estimate is biased.", z_truth)));
      findings.checks.push_back(deviations_check("Its mean is $(M_a + M_b/16)/(M_a + M_b)$.", z_naive));
    } else {
      findings.checks.push_back(deviations_check("Unbiased: " + std::string(names[c]) + ".", z_truth));
    }
  }
  figure.curves.push_back(function_curve(
      "$(M_a + M_b/16)/(M_a + M_b)$", Mark::line, [&](double m) { return (own + m * neighbour_part) / (own + m); }, 1,
      16 * own, true, 60));
  figure.curves.push_back(function_curve(
      "true value 1", Mark::dashes, [](double) { return 1.0; }, 1, 16 * own, true, 2));
  findings.sections = {figure, table};
  return findings;
}

}  // namespace

const Experiment neighbour_bias{
    .name = "neighbour-bias",
    .title = "The bias of merged neighbours, and its cure",
    .group = group_r,
    .question =
        "A pixel merges its reservoir with a neighbour's, whose target is zero where the neighbour sees nothing (here "
        "for $x \\ge \\frac12$). Dividing by all candidates, as the text does, counts some that could never have made "
        "the sample. "
        "How large is the bias, and what removes it?",
    .formula =
        R"(W = \frac1{g(y)}\cdot\frac{\sum_k M_k\,g(y_k)W_k}{Z(y)},\qquad Z_{\text{naive}} = \sum_k M_k,\quad Z(y) = \sum_{k:\,g_k(y)>0}M_k)",
    .source = "Monte Carlo, RIS and reservoirs; Bitterli et al. 2020, section 4.3",
    .fault = "the naive combination is taken for the cure",
    .knobs = {{{"realisations", 30000, "estimates at each point"}, {"candidates", 4, "of the pixel itself"}}},
    .checks = 4,
    .run = run};

}  // namespace montelux::lab
