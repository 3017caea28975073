// B: rates of quasi-Monte Carlo in 1 to 8 dimensions.
#include <fmt/format.h>

#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/estimate.h"

namespace montelux::lab {

namespace {

struct Points {
  const char* name;
  PointSetKind kind;
};
constexpr Points kinds[]{{"independent", PointSetKind::independent},
                         {"Halton, scrambled", PointSetKind::halton},
                         {"Sobol', scrambled", PointSetKind::sobol}};

// The product of 1/2 + x over the coordinates: integral 1.
double mean_of_pass(PointSet set, std::uint32_t dimensions) {
  double sum = 0;
  for (std::uint32_t i = 0; i < set.samples_per_pass; ++i) {
    const Sampler<float> sampler(set, 0u, 0u, i);
    double product = 1;
    for (std::uint32_t d = 0; d < dimensions; ++d) product *= 0.5 + double(sampler.get1(d));
    sum += product;
  }
  return sum / set.samples_per_pass;
}

// How one kind of points does in one dimension after another.
struct Rates {
  Curve exponents;
  std::vector<Curve> errors;  // in each dimension, against the number of points
  std::vector<double> z_mean, z_slope;
  double flattest = -2, flattest_error = 0;
};

Rates measure(const Setup& setup, const Points& points) {
  const std::uint32_t passes = std::max(8u, setup.count("passes")), largest = setup.count("samples");
  // The planted fault takes independent points under every name.
  const PointSetKind kind = setup.fault() ? PointSetKind::independent : points.kind;
  Rates rates;
  rates.exponents = {points.name, Mark::points, {}, {}, {}, {}};
  for (std::uint32_t d = 1; d <= 8; ++d) {
    Curve curve{fmt::format("{}, {}-dimensional", points.name, d), Mark::line, {}, {}, {}, {}};
    std::vector<double> variances, spreads;
    for (std::uint32_t n = 16; n <= largest; n *= 4) {
      std::vector<double> means;
      for (std::uint32_t pass = 0; pass < passes; ++pass)
        means.push_back(mean_of_pass({kind, setup.seed() + 31 * n + d, pass, n}, d));
      const Spread s = spread_of(means);
      curve.x.push_back(n), curve.y.push_back(std::sqrt(s.variance));
      variances.push_back(s.variance), spreads.push_back(s.variance * std::sqrt(2.0 / (passes - 1)));
      rates.z_mean.push_back((s.mean - 1) / s.mean_error);
    }
    const LineFit fit = fit_power_law(curve.x, variances, spreads);
    const double slope = 0.5 * fit.slope, error = 0.5 * fit.slope_error;
    rates.exponents.x.push_back(d), rates.exponents.y.push_back(slope);
    rates.exponents.low.push_back(slope - error), rates.exponents.high.push_back(slope + error);
    rates.z_slope.push_back((slope + 0.5) / error);
    if (slope > rates.flattest) rates.flattest = slope, rates.flattest_error = error;
    rates.errors.push_back(curve);
  }
  return rates;
}

Findings run(const Setup& setup) {
  Figure errors{"errors",
                "Root mean square error against the number of points: independent, and scrambled Sobol'.",
                {"points $N$", true, {}, {}},
                {"rms error", true, {}, {}},
                {},
                false};
  Figure exponents{"rates",
                   "The fitted exponent of the error in 1 to 8 dimensions.",
                   {"dimensions", false, 0.5, 8.5},
                   {"exponent", false, -1.8, 0},
                   {},
                   false};
  Findings findings;
  for (const Points& points : kinds) {
    const Rates rates = measure(setup, points);
    exponents.curves.push_back(rates.exponents);
    if (points.kind != PointSetKind::halton)
      for (std::size_t d : {1u, 4u, 8u}) errors.curves.push_back(rates.errors[d - 1]);
    const std::string name = points.name;
    // A few passes are not quite normal: their squared deviations are summed as Student's, of variance n / (n - 2).
    double sum = 0;
    const double degrees = std::max(8u, setup.count("passes")) - 1;
    for (double z : rates.z_mean) sum += z * z * (degrees - 2) / degrees;
    findings.checks.push_back(
        chi_square_check("Unbiased in every dimension: " + name + ".", sum, double(rates.z_mean.size())));
    findings.checks.push_back(
        points.kind == PointSetKind::independent
            ? deviations_check("Independent points have the exponent $-1/2$ in every dimension.", rates.z_slope)
            : rejected(z_check("Faster than $N^{-1/2}$ in all of 1 to 8 dimensions: " + name + ".", rates.flattest,
                               rates.flattest_error, -0.5)));
  }
  for (const auto& [name, exponent] : {std::pair{"$N^{-1/2}$", -0.5}, std::pair{"$N^{-3/2}$", -1.5}})
    exponents.curves.push_back(function_curve(
        name, Mark::dashes, [e = exponent](double) { return e; }, 0.5, 8.5, false, 2));
  findings.sections = {errors, exponents};
  return findings;
}

}  // namespace

const Experiment qmc_rates{
    .name = "qmc-rates",
    .title = "The rates of quasi-Monte Carlo",
    .group = group_b,
    .question =
        "Monte Carlo converges as $N^{-1/2}$ in any number of dimensions; specially placed points do better. How much, "
        "in 1 to 8 dimensions? The integrand is $\\prod_d(\\frac12 + x_d)$, and the error is that over independent "
        "randomisations of the points.",
    .formula =
        R"(\text{rms error} = O\bigl(N^{-1/2}\bigr)\text{ at random},\qquad O\bigl(N^{-3/2}(\log N)^{(d-1)/2}\bigr)\text{ by scrambled nets})",
    .source =
        "Bulant, Monte Carlo integrování (quasi-Monte Carlo); Owen 1997, Scrambled Net Variance for Integrals of "
        "Smooth Functions",
    .fault = "independent points under every name",
    .knobs = {{{"passes", 48, "randomisations at each N"}, {"samples", 4096, "the largest N"}}},
    .checks = 6,
    .run = run};

}  // namespace montelux::lab
