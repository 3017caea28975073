// K, section 14.3: three densities for one integrand, and the one that the text misprints.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/estimate.h"
#include "mc/power.h"

namespace montelux::lab {

namespace {

// A density (n + 1) x^n, the estimator as it is written for it, and what theory says of one sample.
struct Row {
  const char* name;
  float exponent;
  double (*estimator)(double x);
  double mean, variance;
};

double by_uniform(double x) { return 4 * x * x * x; }
double by_linear(double x) { return 2 * x * x; }
double by_itself(double) { return 1; }
double as_printed(double x) { return 4 * x * x; }

constexpr Row rows[]{{"$p = 1$", 0, by_uniform, 1, 9.0 / 7},
                     {"$p = 2x$", 1, by_linear, 1, 1.0 / 3},
                     {"$p = 4x^3$", 3, by_itself, 1, 0},
                     {"as printed: $4x^2$ with $p = x$", 1, as_printed, 2, 4.0 / 3}};

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  Table table{"variances",
              "Mean and variance of one sample, measured and expected.",
              {"density", "mean", "expected", "variance", "expected"},
              {}};
  Figure rms{"error",
             "Root mean square error of the estimate against the number of samples, as measured (points) and "
             "expected (lines). The density that is proportional to the integrand makes no error at all.",
             {"samples $N$", true, {}, {}},
             {"rms error", true, {}, {}},
             {},
             false};
  Findings findings;
  std::vector<Spread> spreads;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const Row& row = rows[k];
    const auto estimator = setup.fault() && k == 1 ? as_printed : row.estimator;
    const auto values = realisations(
        setup, k, samples, [&](auto& stream) { return estimator(double(sample_power(row.exponent, stream.next()))); });
    spreads.push_back(spread_of(values));
    const Spread& s = spreads.back();
    table.rows.push_back(
        {row.name, with_error(s.mean, s.mean_error), row.mean, with_error(s.variance, s.variance_error), row.variance});
    if (row.variance == 0 || k == 3) continue;
    Curve measured{row.name, Mark::points, {}, {}, {}, {}};
    for (std::size_t n = 1; 100 * n <= values.size(); n *= 4) {
      std::vector<double> squares;
      for (std::size_t i = 0; i + n <= values.size(); i += n) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += values[i + j];
        squares.push_back(std::pow(sum / double(n) - 1, 2));
      }
      measured.x.push_back(double(n)), measured.y.push_back(std::sqrt(spread_of(squares).mean));
    }
    rms.curves.push_back(measured);
    add_expected(rms, function_curve(
                          k == 0 ? "$\\sqrt{9/(7N)}$" : "$\\sqrt{1/(3N)}$", Mark::line,
                          [&](double n) { return std::sqrt(row.variance / n); }, 1, measured.x.back(), true, 2));
  }
  Figure densities{"densities", "The integrand and the densities.", {"$x$", false, {}, {}}, {"", false, {}, {}}, {},
                   false};
  densities.curves = {function_curve("$f = p_3 = 4x^3$", Mark::line, by_uniform, 0, 1, false, 60),
                      function_curve(
                          "$p_1 = 1$", Mark::dashes, [](double) { return 1.0; }, 0, 1, false, 2),
                      function_curve(
                          "$p_2 = 2x$", Mark::dashes, [](double x) { return 2 * x; }, 0, 1, false, 2)};
  findings.sections = {densities, table, rms};
  findings.checks = {
      mean_check("With $p = 1$ the mean is 1.", spreads[0], 1),
      variance_check("With $p = 1$ the variance of one sample is $9/7$.", spreads[0], 9.0 / 7),
      mean_check("With $p = 2x$ the mean is 1.", spreads[1], 1),
      variance_check("With $p = 2x$ the variance of one sample is $1/3$.", spreads[1], 1.0 / 3),
      exact_check("With $p = 4x^3$ the variance is 0.", spreads[2].variance == 0, "every sample has the value 1"),
      rejected(mean_check("The estimator $\\frac1N\\sum 4x_i^2$ that the text prints is biased: its mean is not 1.",
                          spreads[3], 1)),
      rejected(variance_check("The printed variance $14/12$ is not that of $p = 2x$.", spreads[1], 14.0 / 12))};
  return findings;
}

}  // namespace

const Experiment three_densities{
    .name = "three-densities",
    .title = "Three densities for one integrand",
    .group = group_k,
    .question =
        "How much does the choice of the density change the variance of an estimator of $\\int_0^1 4x^3\\,dx$? "
        "The text prints $p(x) = x$ with the estimator $\\frac1N\\sum 4x_i^2$ and the variance $14/(12N)$. But a "
        "density must integrate to one: it is $p = 2x$, the estimator is $\\frac1N\\sum 2x_i^2$, and its "
        "variance is $1/(3N)$.",
    .formula =
        R"(\operatorname{Var}\frac{f(X)}{p(X)} = \int_0^1\frac{f(x)^2}{p(x)}\,dx - 1 = \begin{cases}9/7 & p = 1\\ 1/3 & p = 2x\\ 0 & p = 4x^3\end{cases})",
    .source = "Rendering, section 14.3, equation 14.7",
    .fault = "the printed estimator is taken for the right one of p = 2x",
    .knobs = {{{"samples", 100000, "samples of each density"}}},
    .checks = 7,
    .run = run};

}  // namespace montelux::lab
