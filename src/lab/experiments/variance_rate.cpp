// H, "Variance decreases with sample size", in any number of dimensions.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"

namespace montelux::lab {

namespace {

constexpr std::array<int, 4> dimensions{1, 2, 4, 8};

// The mean of n samples of the product of 1/2 + x over all coordinates, whose integral is 1. The planted fault takes
// one random number for all coordinates.
double mean_of(int dimension, std::uint32_t n, bool fault, RandomStream<float>& stream) {
  double sum = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    double product = 1;
    const double shared = double(stream.next());
    for (int d = 0; d < dimension; ++d) product *= 0.5 + (fault || d == 0 ? shared : double(stream.next()));
    sum += product;
  }
  return sum / n;
}

Findings run(const Setup& setup) {
  const std::uint32_t many = setup.count("realisations"), samples = setup.count("samples");
  Figure figure{"rates",
                "Variance of the mean of $N$ samples, as measured (points) and as theory has it (lines). The "
                "dimension moves the line, but does not turn it.",
                {"samples $N$", true, {}, {}},
                {"variance", true, {}, {}},
                {},
                false};
  Table table{"slopes", "Fitted slopes.", {"dimensions", "variance of one sample", "slope"}, {}};
  Findings findings;
  std::uint32_t purpose = 1;
  for (int d : dimensions) {
    const double one = std::pow(13.0 / 12, d) - 1;
    Curve measured{std::to_string(d) + (d == 1 ? " dimension" : " dimensions"), Mark::points, {}, {}, {}, {}};
    std::vector<double> z, errors;
    for (std::uint32_t n = 1; n <= samples; n *= 4) {
      const Spread s = spread_of(
          realisations(setup, purpose++, many, [&](auto& stream) { return mean_of(d, n, setup.fault(), stream); }));
      measured.x.push_back(n), measured.y.push_back(s.variance), errors.push_back(s.variance_error);
      measured.low.push_back(s.variance - s.variance_error), measured.high.push_back(s.variance + s.variance_error);
      z.push_back((s.variance - one / n) / s.variance_error);
    }
    const LineFit fit = fit_power_law(measured.x, measured.y, errors);
    table.rows.push_back({double(d), one, with_error(fit.slope, fit.slope_error)});
    figure.curves.push_back(measured);
    add_expected(figure, function_curve(
                             "$V/N$, $V = " + with_error(one, 0) + "$", Mark::line, [&](double n) { return one / n; },
                             1, samples, true, 2));
    const std::string in = " in " + std::to_string(d) + (d == 1 ? " dimension." : " dimensions.");
    findings.checks.push_back(deviations_check("The variance is $V/N$" + in, z));
    findings.checks.push_back(z_check("The slope is $-1$" + in, fit.slope, fit.slope_error, -1));
  }
  findings.sections = {figure, table};
  return findings;
}

}  // namespace

const Experiment variance_rate{
    .name = "variance-rate",
    .title = "Variance against the number of samples",
    .group = group_h,
    .question =
        "The variance of a mean falls as $1/N$. Does it do so in any number of dimensions? The integrand is "
        "$\\prod_d(\\frac12 + x_d)$ over the unit cube, whose integral is 1.",
    .formula =
        R"(V\Bigl[\frac1N\sum_{i=1}^N Y_i\Bigr] = \frac1{N^2}\sum_{i=1}^N V[Y_i] = \frac1N V[Y],\qquad V[Y] = \left(\tfrac{13}{12}\right)^d - 1)",
    .source = "CS348B lecture 6, Variance",
    .fault = "one random number for all coordinates",
    .knobs = {{{"realisations", 4000, "estimators at each N"}, {"samples", 256, "the largest N"}}},
    .checks = 8,
    .run = run};

}  // namespace montelux::lab
