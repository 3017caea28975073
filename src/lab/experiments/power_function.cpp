// H, "Example: Power Function": by inversion, and as the largest of several uniform numbers.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/power.h"

namespace montelux::lab {

namespace {

constexpr std::array<std::uint32_t, 3> exponents{1, 3, 8};

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  Findings findings;
  Table cost{"cost", "Uniform random numbers for one sample.", {"$n$", "inversion", "maximum"}, {}};
  for (std::uint32_t k = 0; k < exponents.size(); ++k) {
    const std::uint32_t n = exponents[k];
    const auto inverted = realisations(setup, 2 * k, samples,
                                       [&](auto& stream) { return double(sample_power(float(n), stream.next())); });
    // The planted fault takes the largest of n numbers.
    const auto largest = realisations(setup, 2 * k + 1, samples, [&](auto& stream) {
      return double(sample_power_by_maximum(setup.fault() ? n - 1 : n, stream));
    });
    const auto probabilities = cell_probabilities([&](double x) { return std::pow(x, n + 1); }, 0, 1, 40);
    const auto a = counts_in_cells(inverted, 0, 1, 40), b = counts_in_cells(largest, 0, 1, 40);
    const std::string exponent = std::to_string(n), power = exponent == "1" ? "x" : "x^" + exponent;
    if (k > 0) {
      Figure figure{"power-" + exponent,
                    "Samples of $" + std::to_string(n + 1) + power + "$ by both methods.",
                    {"$x$", false, 0, 1},
                    {"density", false, {}, {}},
                    {},
                    false};
      figure.curves = {histogram("by inversion", a, 0, 1), histogram("by the maximum", b, 0, 1),
                       function_curve(
                           "density", Mark::line, [&](double x) { return (n + 1) * std::pow(x, n); }, 0, 1, false, 80)};
      findings.sections.push_back(figure);
    }
    findings.checks.push_back(counts_check("Inversion has the density for $n = " + exponent + "$.", a, probabilities));
    findings.checks.push_back(
        counts_check("The maximum has the density for $n = " + exponent + "$.", b, probabilities));
    cost.rows.push_back({double(n), 1.0, double(n + 1)});
  }
  findings.sections.push_back(cost);
  return findings;
}

}  // namespace

const Experiment power_function{
    .name = "power-function",
    .title = "The power function",
    .group = group_h,
    .question =
        "Two ways to draw from $p(x) = (n+1)x^n$: the inverse of the distribution function needs a root; the largest "
        "of $n+1$ uniform numbers needs no function at all, but $n+1$ numbers. Do both have the density?",
    .formula =
        R"(X = \sqrt[n+1]{U},\qquad Y = \max(U_1,\dots,U_{n+1}),\qquad P(Y<x) = \prod_{i=1}^{n+1}P(U_i<x) = x^{n+1})",
    .source = "CS348B lecture 6, Example: Power Function",
    .fault = "the largest of n numbers instead of n + 1",
    .knobs = {{{"samples", 100000, "samples of each method"}}},
    .checks = 6,
    .run = run};

}  // namespace montelux::lab
