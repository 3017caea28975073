// B: Russian roulette's variance and efficiency against the probability of survival.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/roulette.h"

namespace montelux::lab {

namespace {

// Y = 4 x^3: mean 1, second moment 16/7.
constexpr double second_moment = 16.0 / 7;
double expected_variance(double q) { return second_moment / q - 1; }

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  const double price = setup["price"];
  Curve variance{"measured", Mark::points, {}, {}, {}, {}}, efficiency = variance;
  std::vector<double> z_mean, z_variance;
  std::uint32_t purpose = 1;
  for (double q : {0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0}) {
    double survivors = 0;
    const Spread s = spread_of(realisations(setup, purpose++, samples, [&](auto& stream) {
      // The planted fault ends with the probability q, as the text calls it, and still divides by q.
      const Roulette<float> r =
          setup.fault() ? roulette(float(1 - q), stream.next()) : roulette(float(q), stream.next());
      if (!r.survives) return 0.0;
      ++survivors;
      const double x = double(stream.next());
      return 4 * x * x * x / q;
    }));
    const double cost = 1 + price * survivors / samples, gain = 1 / (s.variance * cost);
    const double relative = s.variance_error / s.variance;
    variance.x.push_back(q), variance.y.push_back(s.variance);
    variance.low.push_back(s.variance - s.variance_error), variance.high.push_back(s.variance + s.variance_error);
    efficiency.x.push_back(q), efficiency.y.push_back(gain);
    efficiency.low.push_back(gain * (1 - relative)), efficiency.high.push_back(gain * (1 + relative));
    if (s.mean_error == 0)
      z_mean.push_back(1e9);
    else
      z_mean.push_back((s.mean - 1) / s.mean_error),
          z_variance.push_back((s.variance - expected_variance(q)) / s.variance_error);
  }
  Findings findings;
  findings.sections = {
      Figure{"variance",
             "Variance of $Z$ against the probability of survival.",
             {"$q$", true, {}, {}},
             {"variance", true, {}, {}},
             {variance, function_curve("$E[Y^2]/q - 1$", Mark::line, expected_variance, 0.05, 1, true, 60)},
             false},
      Figure{
          "efficiency",
          "Efficiency where asking costs 1 and a value of $Y$ costs as much as `price` says: roulette never "
          "lowers the variance, but where values are dear and often small it pays.",
          {"$q$", true, {}, {}},
          {"efficiency", false, {}, {}},
          {efficiency, function_curve(
                           "theory", Mark::line, [&](double q) { return 1 / (expected_variance(q) * (1 + price * q)); },
                           0.05, 1, true, 60)},
          false}};
  findings.checks = {deviations_check("The expectation is unchanged for every $q$.", z_mean),
                     deviations_check("The variance is $E[Y^2]/q - E[Y]^2$ for every $q$.", z_variance)};
  return findings;
}

}  // namespace

const Experiment russian_roulette{
    .name = "roulette",
    .title = "Russian roulette",
    .group = group_b,
    .question =
        "A random variable is kept with the probability $q$ and then divided by it, and is zero otherwise. Does the "
        "expectation stay, what happens to the variance, and when does it pay? (The text calls $q$ the probability of "
        "ending; "
        "it is that of survival.)",
    .formula =
        R"(Z = \begin{cases}Y/q & \xi < q\\ 0 & \text{otherwise}\end{cases},\qquad E[Z] = q\,\frac{E[Y]}q + (1-q)\cdot 0 = E[Y],\qquad V[Z] = \frac{E[Y^2]}q - E[Y]^2)",
    .source = "Bulant, Monte Carlo integrování, ending the recursion by Russian roulette",
    .fault = "the recursion ends with the probability q, as the text says",
    .knobs = {{{"samples", 200000, "samples at each q"}, {"price", 20, "of a value of Y, where asking costs 1"}}},
    .checks = 2,
    .run = run};

}  // namespace montelux::lab
