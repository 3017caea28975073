// R: resampled importance sampling against the number of candidates.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/resampling.h"

namespace montelux::lab {

namespace {

double f(double x) { return 4 * x * x * x; }
double g(double x) { return x * x; }

// Of one candidate, and of one sample from the normalised target: (int f^2 / p) - 1 and G (int f^2 / g) - 1.
constexpr double source_variance = 9.0 / 7, target_variance = 1.0 / 15;

double expected_variance(double candidates, double resampled) {
  return source_variance / candidates + (1 - 1 / candidates) * target_variance / resampled;
}

// The planted fault takes the chosen point for a sample of the target itself, whose integral is 1/3.
double as_if_from_target(std::uint32_t candidates, RandomStream<float>& stream) {
  WeightedReservoir<double> reservoir;
  for (std::uint32_t i = 0; i < candidates; ++i) {
    const double x = double(stream.next());
    reservoir.add(x, float(g(x)), stream.next());
  }
  return f(reservoir.value) / std::max(1e-9, g(reservoir.value)) / 3;
}

Findings run(const Setup& setup) {
  const std::uint32_t many = setup.count("realisations"), largest = setup.count("candidates");
  Figure figure{"variance",
                "Variance of the estimate against the number of candidates $M$: it falls from that of the "
                "source density to that of the target. Lines: theory.",
                {"candidates $M$", true, {}, {}},
                {"variance", true, {}, {}},
                {},
                false};
  Figure means{"mean",
               "The mean of the estimates, with its standard error: unbiased for every $M$.",
               {"candidates $M$", true, {}, {}},
               {"mean", false, {}, {}},
               {},
               false};
  Findings findings;
  std::uint32_t purpose = 1;
  for (std::uint32_t resampled : {1u, 4u}) {
    const std::string n = "$N = " + std::to_string(resampled) + "$";
    Curve variance{n, Mark::points, {}, {}, {}, {}}, mean = variance;
    std::vector<double> z_mean, z_variance;
    for (std::uint32_t m = 1; m <= largest; m *= 2) {
      const ResamplingCounts counts{m, resampled};
      const Spread s = spread_of(realisations(setup, purpose++, many, [&](auto& stream) {
        return setup.fault() ? as_if_from_target(m, stream)
                             : resampled_estimate(f, g, UniformInterval{}, counts, stream);
      }));
      variance.x.push_back(m), variance.y.push_back(s.variance);
      variance.low.push_back(s.variance - s.variance_error), variance.high.push_back(s.variance + s.variance_error);
      mean.x.push_back(m), mean.y.push_back(s.mean);
      mean.low.push_back(s.mean - s.mean_error), mean.high.push_back(s.mean + s.mean_error);
      z_mean.push_back((s.mean - 1) / s.mean_error);
      z_variance.push_back((s.variance - expected_variance(m, resampled)) / s.variance_error);
    }
    figure.curves.push_back(variance);
    add_expected(figure, function_curve(
                             "theory, " + n, Mark::line, [&](double m) { return expected_variance(m, resampled); }, 1,
                             largest, true, 60));
    means.curves.push_back(mean);
    findings.checks.push_back(deviations_check("Unbiased for every $M$, with " + n + ".", z_mean));
    findings.checks.push_back(deviations_check("The variance is that of theory, with " + n + ".", z_variance));
  }
  means.curves.push_back(function_curve(
      "true value 1", Mark::dashes, [](double) { return 1.0; }, 1, largest, true, 2));
  findings.sections = {figure, means};
  return findings;
}

}  // namespace

const Experiment ris{
    .name = "ris",
    .title = "Resampled importance sampling against the number of candidates",
    .group = group_r,
    .question =
        "Candidates are drawn from a simple density ($p = 1$), and $N$ of $M$ are chosen in proportion to a target "
        "that "
        "need not be normalised ($g = x^2$). Is the estimate of $\\int_0^1 4x^3\\,dx$ unbiased for every $M$, and how "
        "fast does its variance fall to that of sampling the target itself?",
    .formula =
        R"(\hat I = \frac1N\sum_{i=1}^N\frac{f(y_i)}{g(y_i)}\cdot\frac1M\sum_{j=1}^M\frac{g(x_j)}{p(x_j)},\qquad V = \frac1M V_p + \Bigl(1-\frac1M\Bigr)\frac{V_g}{N},\quad V_p = \tfrac97,\; V_g = \tfrac1{15})",
    .source = "Monte Carlo, RIS and reservoirs; Talbot, Cline and Egbert 2005",
    .fault = "the chosen point is taken for a sample of the target itself",
    .knobs = {{{"realisations", 20000, "estimates at each M"}, {"candidates", 128, "the largest M"}}},
    .checks = 4,
    .run = run};

}  // namespace montelux::lab
