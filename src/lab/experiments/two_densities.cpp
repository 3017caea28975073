// F, "Combining Multiple PDFs": two densities over a family of integrands.
#include <algorithm>
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/linear.h"
#include "mc/mis.h"

namespace montelux::lab {

namespace {

// Two straight densities, high at one end each, and integrands between 3 x^2 and 3 (1 - x)^2; all integrals are 1.
constexpr float low = 0.1f, high = 1.0f;
double density(std::size_t k, double x) {
  return double(k == 0 ? linear_density(low, high, float(x)).value : linear_density(high, low, float(x)).value);
}
double draw(std::size_t k, float u) {
  return double(k == 0 ? sample_linear(low, high, u) : sample_linear(high, low, u));
}
double integrand(double t, double x) { return 3 * ((1 - t) * x * x + t * (1 - x) * (1 - x)); }

double weight(MisHeuristic heuristic, std::size_t k, double x) {
  const std::array<float, 2> products{float(density(0, x)), float(density(1, x))};
  return double(mis_weight<float>(heuristic, products, k));
}

// One sample of each density, weighted. The planted fault takes 0.6 for the weight of either.
double combined(MisHeuristic heuristic, double t, bool fault, RandomStream<float>& stream) {
  double sum = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double x = draw(k, stream.next());
    sum += (fault ? 0.6 : weight(heuristic, k, x)) * integrand(t, x) / density(k, x);
  }
  return sum;
}

// Its variance by quadrature; weights of the other heuristics jump, so the panels are many.
double combined_variance(MisHeuristic heuristic, double t) {
  double variance = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto part = [&](double x) { return weight(heuristic, k, x) * integrand(t, x); };
    const double mean = quadrature(part, 0, 1, 400);
    variance += quadrature([&](double x) { return part(x) * part(x) / density(k, x); }, 0, 1, 400) - mean * mean;
  }
  return variance;
}
double single_variance(std::size_t k, double t) {
  return quadrature([&](double x) { return std::pow(integrand(t, x), 2) / density(k, x); }, 0, 1, 64) - 1;
}

constexpr std::array<double, 5> family{0, 0.25, 0.5, 0.75, 1};

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  Figure figure{"variance",
                "Variance of an estimate from two samples, against the integrand: two of one density, or one of "
                "each, combined. Lines: quadrature.",
                {"integrand $t$", false, {}, {}},
                {"variance", true, {}, {}},
                {},
                false};
  Findings findings;
  std::uint32_t purpose = 1;
  double worst_excess = -1e9;
  const auto add_curve = [&](const std::string& name, auto sample, auto variance) {
    Curve curve{name, Mark::points, {}, {}, {}, {}};
    std::vector<double> z_mean, z_variance;
    for (double t : family) {
      const Spread s =
          spread_of(realisations(setup, purpose++, samples, [&](auto& stream) { return sample(t, stream); }));
      curve.x.push_back(t), curve.y.push_back(s.variance);
      curve.low.push_back(s.variance - s.variance_error), curve.high.push_back(s.variance + s.variance_error);
      z_mean.push_back((s.mean - 1) / s.mean_error),
          z_variance.push_back((s.variance - variance(t)) / s.variance_error);
    }
    figure.curves.push_back(curve);
    add_expected(figure, function_curve("quadrature", Mark::line, variance, 0, 1, false, 41));
    findings.checks.push_back(deviations_check("Unbiased for every integrand: " + name + ".", z_mean));
    findings.checks.push_back(deviations_check("The variance is that of quadrature: " + name + ".", z_variance));
  };
  for (std::size_t k = 0; k < 2; ++k)
    add_curve(
        k == 0 ? "two of $p_1$" : "two of $p_2$",
        [k](double t, RandomStream<float>& stream) {
          const double x = draw(k, stream.next()), y = draw(k, stream.next());
          return 0.5 * (integrand(t, x) / density(k, x) + integrand(t, y) / density(k, y));
        },
        [k](double t) { return 0.5 * single_variance(k, t); });
  for (const NamedMisHeuristic& heuristic : mis_heuristic_names)
    add_curve(
        std::string(heuristic.name),
        [&](double t, RandomStream<float>& stream) { return combined(heuristic.heuristic, t, setup.fault(), stream); },
        [&](double t) { return combined_variance(heuristic.heuristic, t); });
  // Veach and Guibas 1995, theorem 1: no weights beat the balance heuristic by more than (1 / min n - 1 / sum n) I^2.
  for (double t : family)
    for (const NamedMisHeuristic& heuristic : mis_heuristic_names)
      worst_excess = std::max(worst_excess,
                              combined_variance(MisHeuristic::balance, t) - combined_variance(heuristic.heuristic, t));
  findings.checks.push_back(exact_check("No other heuristic beats the balance heuristic by more than its bound of 1/2.",
                                        worst_excess <= 0.5,
                                        "largest gain by quadrature: " + with_error(worst_excess, 0)));
  findings.sections = {figure};
  return findings;
}

}  // namespace

const Experiment two_densities{
    .name = "two-densities",
    .title = "Combining two densities",
    .group = group_f,
    .question =
        "Each of two densities suits one end of a family of integrands $f_t = 3(1-t)x^2 + 3t(1-x)^2$. Samples of both "
        "are combined by weights that sum to one. Which heuristic comes near to the better density everywhere?",
    .formula =
        R"(F = \sum_i\frac1{n_i}\sum_j w_i(X_{ij})\frac{f(X_{ij})}{p_i(X_{ij})},\qquad w_i^{\text{balance}} = \frac{n_ip_i}{\sum_k n_kp_k},\qquad w_i^{\text{power}} = \frac{(n_ip_i)^2}{\sum_k(n_kp_k)^2})",
    .source = "COS 526, Combining Multiple PDFs; Veach and Guibas 1995",
    .fault = "weights that sum to 1.2",
    .knobs = {{{"samples", 60000, "estimates at each integrand"}}},
    .checks = 13,
    .run = run};

}  // namespace montelux::lab
