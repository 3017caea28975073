// H, "Variance Reduction": one over variance times cost.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/power.h"
#include "mc/rejection.h"
#include "mc/roulette.h"

namespace montelux::lab {

namespace {

// One sample of the integral of 4 x^3 and how many random numbers it took.
struct Sample {
  double value;
  std::uint32_t cost;
};
struct Technique {
  const char* name;
  Sample (*draw)(RandomStream<float>&);
  double variance, cost;  // of one sample, by theory
};

Sample uniform(RandomStream<float>& stream) {
  const double x = double(stream.next());
  return {4 * x * x * x, 1};
}
Sample antithetic(RandomStream<float>& stream) {
  const double x = double(stream.next()), y = 1 - x;
  return {2 * (x * x * x + y * y * y), 1};
}
Sample by_inversion(RandomStream<float>& stream) {
  const double x = double(sample_power(1.0f, stream.next()));
  return {2 * x * x, 1};
}
Sample by_maximum(RandomStream<float>& stream) {
  const double x = double(sample_power_by_maximum(1u, stream));
  return {2 * x * x, 2};
}
Sample by_rejection(RandomStream<float>& stream) {
  const Rejection<float> r = sample_under_curve([](float x) { return 2 * x; }, 2, stream);
  return {2 * double(r.value) * double(r.value), 2 * r.trials};
}
Sample with_roulette(RandomStream<float>& stream) {
  const Roulette<float> r = roulette(0.5f, stream.next());
  if (!r.survives) return {0, 1};
  const double x = double(stream.next());
  return {4 * x * x * x * double(r.weight), 2};
}

// Antithetic: (f(x) + f(1 - x)) / 2 = 2 (1 - 3x + 3x^2) has the variance 1/5.
constexpr Technique techniques[]{{"uniform", uniform, 9.0 / 7, 1},
                                 {"antithetic pairs", antithetic, 1.0 / 5, 1},
                                 {"$p = 2x$ by inversion", by_inversion, 1.0 / 3, 1},
                                 {"$p = 2x$ by the maximum", by_maximum, 1.0 / 3, 2},
                                 {"$p = 2x$ by rejection", by_rejection, 1.0 / 3, 4},
                                 {"uniform, with roulette at $q = 1/2$", with_roulette, 25.0 / 7, 1.5}};

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  Table table{"efficiency",
              "Efficiency of the estimators of $\\int_0^1 4x^3\\,dx$; the cost counts random numbers.",
              {"estimator", "variance of one", "cost of one", "efficiency", "expected"},
              {}};
  Figure figure{"efficiency",
                "Efficiency from means of $N$ samples: it does not depend on $N$. Lines: theory.",
                {"samples $N$", true, {}, {}},
                {"efficiency", true, {}, {}},
                {},
                false};
  Findings findings;
  std::uint32_t purpose = 1;
  for (const Technique& technique : techniques) {
    const double expected = 1 / (technique.variance * technique.cost);
    Curve measured{technique.name, Mark::points, {}, {}, {}, {}};
    std::vector<double> z;
    Spread one{};
    double cost_of_one = 0;
    for (std::uint32_t n = 1; n <= 256; n *= 4) {
      std::vector<double> costs;
      const auto means = realisations(setup, purpose++, samples / n, [&](auto& stream) {
        double sum = 0, cost = 0;
        for (std::uint32_t i = 0; i < n; ++i) {
          const Sample sample = technique.draw(stream);
          sum += sample.value;
          // The planted fault pays for accepted proposals alone.
          cost += setup.fault() && technique.draw == by_rejection ? 2 : sample.cost;
        }
        costs.push_back(cost);
        return sum / n;
      });
      const Spread s = spread_of(means), cost = spread_of(costs);
      if (n == 1) one = s, cost_of_one = cost.mean;
      const double efficiency = 1 / (s.variance * cost.mean);
      const double error = efficiency * std::hypot(s.variance_error / s.variance, cost.mean_error / cost.mean);
      measured.x.push_back(n), measured.y.push_back(efficiency);
      measured.low.push_back(efficiency - error), measured.high.push_back(efficiency + error);
      // Of its inverse, which is nearer to normal.
      z.push_back((1 - efficiency / expected) * efficiency / error);
    }
    figure.curves.push_back(measured);
    add_expected(figure, function_curve(
                             "", Mark::line, [&](double) { return expected; }, 1, 256, true, 2));
    table.rows.push_back({technique.name, with_error(one.variance, one.variance_error), cost_of_one,
                          1 / (one.variance * cost_of_one), expected});
    findings.checks.push_back(
        deviations_check("The efficiency is as expected at every $N$: " + std::string(technique.name) + ".", z));
  }
  findings.sections = {table, figure};
  return findings;
}

}  // namespace

const Experiment efficiency_of_estimators{
    .name = "efficiency",
    .title = "Efficiency: variance times cost",
    .group = group_h,
    .question =
        "Which estimator is best for the same work? Its efficiency, one over variance times cost, is the same for "
        "every number of samples, so estimators can be compared by it. Cost is counted here in random numbers.",
    .formula = R"(\varepsilon = \frac1{V\cdot C},\qquad \frac1{\frac{V}{N}\cdot NC} = \frac1{VC})",
    .source = "CS348B lecture 6, Variance Reduction",
    .fault = "proposals that were rejected are not paid for",
    .knobs = {{{"samples", 200000, "samples of each estimator at each N"}}},
    .checks = 6,
    .run = run};

}  // namespace montelux::lab
