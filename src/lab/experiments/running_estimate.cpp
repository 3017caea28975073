// K, figure 14.1: how the estimate of one integral settles.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/estimate.h"

namespace montelux::lab {

namespace {

constexpr double variance_of_one = 9.0 / 7;

double cube(double x) { return 4 * x * x * x; }

// The planted fault uses every random number twice, and so has half as many independent ones as it says.
double mean_of(std::uint32_t n, bool fault, RandomStream<float>& stream) {
  Moments moments;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double value = primary_estimate(cube, UniformInterval{}, stream);
    moments.add(value);
    if (fault && ++i < n) moments.add(value);
  }
  return moments.mean;
}

Figure two_estimates(const Setup& setup, std::uint32_t samples) {
  Figure figure{"two-estimates",
                "Two realisations of the estimator against the number of samples. The band is one "
                "standard deviation, $\\sqrt{9/(7N)}$, about the true value.",
                {"samples $N$", true, {}, {}},
                {"estimate", false, -0.2, 2.2},
                {},
                false};
  Curve truth = function_curve(
      "true value 1", Mark::dashes, [](double) { return 1.0; }, 1, samples, true, 60);
  for (double n : truth.x) {
    const double sigma = std::sqrt(variance_of_one / n);
    truth.low.push_back(1 - sigma), truth.high.push_back(1 + sigma);
  }
  figure.curves.push_back(truth);
  for (std::uint32_t k = 0; k < 2; ++k) {
    const std::vector<double> all = running_estimates(cube, UniformInterval{}, samples, setup.stream(1, k));
    Curve curve{k == 0 ? "first estimator" : "second estimator", Mark::line, {}, {}, {}, {}};
    // Denser than the eye on a logarithmic axis, no denser than the file needs.
    for (double n = 1; n <= samples; n = std::max(n + 1, std::floor(n * 1.02)))
      curve.x.push_back(n), curve.y.push_back(all[std::size_t(n) - 1]);
    figure.curves.push_back(curve);
  }
  return figure;
}

Findings run(const Setup& setup) {
  const std::uint32_t many = setup.count("realisations"), samples = setup.count("samples");
  Curve mean{"mean of the estimators", Mark::points, {}, {}, {}, {}};
  Curve variance{"variance of the estimators", Mark::points, {}, {}, {}, {}};
  std::vector<double> errors, z_mean, z_variance;
  for (std::uint32_t n = 1, purpose = 2; n <= samples; n *= 2, ++purpose) {
    const Spread s =
        spread_of(realisations(setup, purpose, many, [&](auto& stream) { return mean_of(n, setup.fault(), stream); }));
    mean.x.push_back(n), mean.y.push_back(s.mean);
    mean.low.push_back(s.mean - s.mean_error), mean.high.push_back(s.mean + s.mean_error);
    variance.x.push_back(n), variance.y.push_back(s.variance), errors.push_back(s.variance_error);
    variance.low.push_back(s.variance - s.variance_error), variance.high.push_back(s.variance + s.variance_error);
    z_mean.push_back((s.mean - 1) / s.mean_error);
    z_variance.push_back((s.variance - variance_of_one / n) / s.variance_error);
  }
  const LineFit fit = fit_power_law(variance.x, variance.y, errors);

  Findings findings;
  findings.sections.push_back(two_estimates(setup, samples));
  findings.sections.push_back(
      Figure{"mean",
             "The mean over all realisations, with its standard error.",
             {"samples $N$", true, {}, {}},
             {"mean", false, {}, {}},
             {mean, function_curve(
                        "true value 1", Mark::dashes, [](double) { return 1.0; }, 1, samples, true, 2)},
             false});
  findings.sections.push_back(
      Figure{"variance",
             "The variance over all realisations falls as $1/N$: a straight line of slope $-1$.",
             {"samples $N$", true, {}, {}},
             {"variance", true, {}, {}},
             {variance, function_curve(
                            "$9/(7N)$", Mark::line, [](double n) { return variance_of_one / n; }, 1, samples, true, 2)},
             false});
  findings.checks = {deviations_check("The mean of the estimators is 1 for every $N$.", z_mean),
                     deviations_check("Their variance is $9/(7N)$ for every $N$.", z_variance),
                     z_check("The slope of the logarithms is $-1$.", fit.slope, fit.slope_error, -1)};
  return findings;
}

}  // namespace

const Experiment running_estimate{
    .name = "running-estimate",
    .title = "How an estimate settles",
    .group = group_k,
    .question =
        "A Monte Carlo estimator of $\\int_0^1 4x^3\\,dx = 1$ with uniform samples: how does one realisation "
        "behave as samples are added, and how do the mean and the variance of many realisations?",
    .formula =
        R"(\hat I = \frac1N\sum_{i=1}^N 4x_i^3,\qquad \operatorname{Var}\hat I = \frac1N\int_0^1\left(4x^3-1\right)^2dx = \frac{9}{7N})",
    .source = "Rendering, equations 14.7 to 14.9 and figure 14.1",
    .fault = "every random number is used twice",
    .knobs = {{{"realisations", 600, "estimators at each N"}, {"samples", 1024, "the largest N"}}},
    .checks = 3,
    .run = run};

}  // namespace montelux::lab
