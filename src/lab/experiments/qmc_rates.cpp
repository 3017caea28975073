// B: rates of quasi-Monte Carlo in 1 to 8 dimensions.
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

Findings run(const Setup& setup) {
  const std::uint32_t passes = std::max(8u, setup.count("passes")), most = setup.count("samples");
  Figure errors{"errors",
                "Root mean square error against the number of points: independent, and scrambled Sobol'.",
                {"points $N$", true, {}, {}},
                {"rms error", true, {}, {}},
                {},
                false};
  Figure rates{"rates",
               "The fitted exponent of the error in 1 to 8 dimensions.",
               {"dimensions", false, 0.5, 8.5},
               {"exponent", false, -1.8, 0},
               {},
               false};
  Findings findings;
  for (const Points& points : kinds) {
    Curve rate{points.name, Mark::points, {}, {}, {}, {}};
    std::vector<double> z_mean, z_slope;
    double steepest = 0, flattest = -2, flattest_error = 0;
    for (std::uint32_t d = 1; d <= 8; ++d) {
      Curve curve{std::string(points.name) + ", " + std::to_string(d) + "-dimensional", Mark::line, {}, {}, {}, {}};
      std::vector<double> variances, spreads;
      for (std::uint32_t n = 16; n <= most; n *= 4) {
        std::vector<double> means;
        for (std::uint32_t pass = 0; pass < passes; ++pass) {
          // The planted fault takes independent points for all sets.
          const PointSetKind kind = setup.fault() ? PointSetKind::independent : points.kind;
          means.push_back(mean_of_pass({kind, setup.seed() + 31 * n + d, pass, n}, d));
        }
        const Spread s = spread_of(means);
        curve.x.push_back(n), curve.y.push_back(std::sqrt(s.variance));
        variances.push_back(s.variance), spreads.push_back(s.variance * std::sqrt(2.0 / (passes - 1)));
        z_mean.push_back((s.mean - 1) / s.mean_error);
      }
      const LineFit fit = fit_power_law(curve.x, variances, spreads);
      const double slope = 0.5 * fit.slope, error = 0.5 * fit.slope_error;
      rate.x.push_back(d), rate.y.push_back(slope), rate.low.push_back(slope - error),
          rate.high.push_back(slope + error);
      z_slope.push_back((slope + 0.5) / error);
      steepest = std::min(steepest, slope);
      if (slope > flattest) flattest = slope, flattest_error = error;
      if ((d == 1 || d == 4 || d == 8) && points.kind != PointSetKind::halton) errors.curves.push_back(curve);
    }
    rates.curves.push_back(rate);
    const std::string name = points.name;
    // A few passes are not quite normal: their squared deviations are summed as Student's, of variance n / (n - 2).
    double sum = 0;
    const double degrees = passes - 1;
    for (double z : z_mean) sum += z * z * (degrees - 2) / degrees;
    findings.checks.push_back(
        chi_square_check("Unbiased in every dimension: " + name + ".", sum, double(z_mean.size())));
    if (points.kind == PointSetKind::independent) {
      findings.checks.push_back(
          deviations_check("Independent points have the exponent $-1/2$ in every dimension.", z_slope));
    } else {
      findings.checks.push_back(rejected(z_check("Faster than $N^{-1/2}$ in all of 1 to 8 dimensions: " + name + ".",
                                                 flattest, flattest_error, -0.5)));
    }
  }
  rates.curves.push_back(function_curve(
      "$N^{-1/2}$", Mark::dashes, [](double) { return -0.5; }, 0.5, 8.5, false, 2));
  rates.curves.push_back(function_curve(
      "$N^{-3/2}$", Mark::dashes, [](double) { return -1.5; }, 0.5, 8.5, false, 2));
  findings.sections = {errors, rates};
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
