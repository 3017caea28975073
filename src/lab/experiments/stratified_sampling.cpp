// F, "Stratified Sampling": subdomains estimated separately.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"

namespace montelux::lab {

namespace {

// The variance of 4 x^3 for x uniform in [a, b].
double variance_within(double a, double b) {
  const double mean = (std::pow(b, 4) - std::pow(a, 4)) / (b - a);
  return 16 * (std::pow(b, 7) - std::pow(a, 7)) / (7 * (b - a)) - mean * mean;
}
// Of the estimate with one sample in each of n equal strata.
double stratified_variance(double n) {
  double sum = 0;
  for (double k = 0; k < n; k += 1) sum += variance_within(k / n, (k + 1) / n);
  return sum / (n * n);
}

// The planted fault shifts all samples by one random number.
double stratified(std::uint32_t n, bool fault, RandomStream<float>& stream) {
  double sum = 0;
  const double shared = double(stream.next());
  for (std::uint32_t k = 0; k < n; ++k) {
    const double x = (k + (fault ? shared : double(stream.next()))) / n;
    sum += 4 * x * x * x;
  }
  return sum / n;
}
double plain(std::uint32_t n, RandomStream<float>& stream) {
  double sum = 0;
  for (std::uint32_t k = 0; k < n; ++k) {
    const double x = double(stream.next());
    sum += 4 * x * x * x;
  }
  return sum / n;
}

// The indicator of a quarter disk on n x n strata: an edge cuts only some of them.
double quarter_disk(std::uint32_t side, bool strata, RandomStream<float>& stream) {
  double hits = 0;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const Vec2f u = stream.next2();
    const double x = strata ? (i % side + double(u.x)) / side : double(u.x);
    const double y = strata ? (i / side + double(u.y)) / side : double(u.y);
    hits += x * x + y * y < 1;
  }
  return hits / (side * side);
}

struct Series {
  Curve curve;
  std::vector<double> errors, z;
};
void add(Series& series, double n, const Spread& s) {
  series.curve.x.push_back(n), series.curve.y.push_back(s.variance), series.errors.push_back(s.variance_error);
  series.curve.low.push_back(s.variance - s.variance_error), series.curve.high.push_back(s.variance + s.variance_error);
}

Findings run(const Setup& setup) {
  const std::uint32_t many = setup.count("realisations");
  Series one{{"one sample in each stratum", Mark::points, {}, {}, {}, {}}, {}, {}},
      random{{"plain", Mark::points, {}, {}, {}, {}}, {}, {}};
  Series edge{{"quarter disk, stratified", Mark::points, {}, {}, {}, {}}, {}, {}},
      edge_plain{{"quarter disk, plain", Mark::points, {}, {}, {}, {}}, {}, {}};
  std::uint32_t purpose = 1;
  for (std::uint32_t n = 1; n <= 256; n *= 2) {
    add(one, n, spread_of(realisations(setup, purpose++, many, [&](auto& stream) {
          return stratified(n, setup.fault(), stream);
        })));
    add(random, n, spread_of(realisations(setup, purpose++, many, [&](auto& stream) { return plain(n, stream); })));
    one.z.push_back((one.curve.y.back() - stratified_variance(n)) / one.errors.back());
    random.z.push_back((random.curve.y.back() - 9.0 / 7 / n) / random.errors.back());
  }
  for (std::uint32_t side : {2u, 4u, 8u, 16u, 32u}) {
    const std::uint32_t fewer = std::max(200u, many / 4);
    add(edge, side * side, spread_of(realisations(setup, purpose++, fewer, [&](auto& stream) {
          return quarter_disk(side, true, stream);
        })));
    add(edge_plain, side * side, spread_of(realisations(setup, purpose++, fewer, [&](auto& stream) {
          return quarter_disk(side, false, stream);
        })));
  }
  const LineFit fit = fit_power_law(edge.curve.x, edge.curve.y, edge.errors);
  // From eight strata on the variance within a stratum is that of a straight line.
  const std::size_t tail = 4;
  const LineFit smooth = fit_power_law(std::span(one.curve.x).subspan(tail), std::span(one.curve.y).subspan(tail),
                                       std::span(one.errors).subspan(tail));
  Findings findings;
  findings.sections = {Figure{"smooth",
                              "Variance for $4x^3$, plain and with one sample in each of $N$ strata. Lines: theory.",
                              {"samples $N$", true, {}, {}},
                              {"variance", true, {}, {}},
                              {random.curve,
                               function_curve(
                                   "$9/(7N)$", Mark::line, [](double n) { return 9.0 / 7 / n; }, 1, 256, true, 2),
                               one.curve,
                               function_curve(
                                   "$\\frac{1}{N^2}\\sum_k \\sigma_k^2$", Mark::line,
                                   [](double n) { return stratified_variance(std::round(n)); }, 1, 256, true, 9)},
                              false},
                       Figure{"edge",
                              "Variance for the indicator of a quarter disk, whose edge crosses some of the strata.",
                              {"samples $N$", true, {}, {}},
                              {"variance", true, {}, {}},
                              {edge_plain.curve, edge.curve},
                              false}};
  findings.checks = {
      deviations_check("Plain sampling has the variance $9/(7N)$.", random.z),
      deviations_check("Stratified sampling has the variance $\\frac1{N^2}\\sum_k\\sigma_k^2$.", one.z),
      z_check("For smooth integrands it falls as $N^{-3}$.", smooth.slope, smooth.slope_error, -3),
      rejected(z_check("Across an edge it falls faster than $N^{-1}$.", fit.slope, fit.slope_error, -1))};
  return findings;
}

}  // namespace

const Experiment stratified_sampling{
    .name = "stratified",
    .title = "Stratified against plain sampling",
    .group = group_f,
    .question =
        "The domain is cut into $N$ equal strata with one sample in each. The estimate is still unbiased, and its "
        "variance "
        "is only that within the strata. How much is gained for a smooth integrand, and how much across an edge?",
    .formula =
        R"(F_N = \frac1N\sum_{k=1}^M N_kF_k,\qquad \operatorname{Var}F_N = \frac1{N^2}\sum_{k=1}^M N_k\,\sigma_k^2,\qquad \sigma_k^2 = \operatorname{Var}[f(X)\,|\,X\in k])",
    .source = "COS 526, Stratified Sampling",
    .fault = "one random number shifts the samples of all strata",
    .knobs = {{{"realisations", 4000, "estimates at each N"}}},
    .checks = 4,
    .run = run};

}  // namespace montelux::lab
