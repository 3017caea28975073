// K, equations 14.19 to 14.23: samples by the inverse of the distribution function.
#include <cmath>
#include <numbers>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/piecewise.h"

namespace montelux::lab {

namespace {

using std::numbers::pi;

constexpr std::array<double, 4> events{0.2, 0.1, 0.2, 0.5};

// Figure 14.2: four events, by running sums and by a table of aliases.
template <class Choice>
std::vector<double> count_events(const Setup& setup, std::uint32_t purpose, const Choice& choice) {
  std::vector<double> counts(events.size());
  RandomStream<float> stream = setup.stream(purpose);
  for (std::uint32_t i = 0; i < setup.count("samples"); ++i) counts[choice.sample(stream.next()).index] += 1;
  return counts;
}

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  const auto by_sums = count_events(setup, 1, DiscreteCdf(events));
  const auto by_aliases = count_events(setup, 2, AliasTable(events));
  Figure discrete{"events",
                  "Four events of the probabilities 0.2, 0.1, 0.2 and 0.5: frequencies against probabilities.",
                  {"event", false, {}, {}},
                  {"probability", false, {}, {}},
                  {},
                  false};
  discrete.curves.push_back(histogram("frequency", by_sums, 0.5, 4.5));
  discrete.curves.push_back({"probability", Mark::points, {1, 2, 3, 4}, {0.2, 0.1, 0.2, 0.5}, {}, {}});

  // Equation 14.23. The planted fault inverts 1 - cos, the distribution function of the uniform hemisphere.
  const auto angles = realisations(setup, 3, samples, [&](auto& stream) {
    const double alpha = double(stream.next());
    return setup.fault() ? std::acos(1 - alpha) : std::acos(std::sqrt(1 - alpha));
  });
  const auto angle_cdf = [](double theta) { return std::pow(std::sin(theta), 2); };
  const auto angle_counts = counts_in_cells(angles, 0, pi / 2, 36);
  Figure angle{"angle",
               "The polar angle of a diffuse emitter's direction: histogram against the density.",
               {"$\\theta$", false, {}, {}},
               {"density", false, {}, {}},
               {},
               false};
  angle.curves = {histogram("samples", angle_counts, 0, pi / 2),
                  function_curve(
                      "$2\\sin\\theta\\cos\\theta$", Mark::line, [](double t) { return 2 * std::sin(t) * std::cos(t); },
                      0, pi / 2, false, 90)};

  // Any density at all, from a table of its values at 64 cells.
  std::vector<double> weights;
  for (int i = 0; i < 64; ++i) weights.push_back(1.05 + std::sin(13 * (i + 0.5) / 64) * std::cos(5 * (i + 0.5) / 64));
  const PiecewiseConstant1 table(weights);
  const auto tabulated =
      realisations(setup, 4, samples, [&](auto& stream) { return double(table.sample(stream.next()).x); });
  std::vector<double> probabilities;
  double sum = 0;
  for (double w : weights) sum += w;
  for (double w : weights) probabilities.push_back(w / sum);
  const auto table_counts = counts_in_cells(tabulated, 0, 1, 64);
  Figure free_form{
      "table", "A density known only by a table of 64 values.", {"$x$", false, {}, {}}, {"density", false, {}, {}}, {},
      false};
  Curve steps{"table", Mark::steps, {}, {}, {}, {}};
  for (std::size_t i = 0; i <= 64; ++i)
    steps.x.push_back(double(i) / 64), steps.y.push_back(64 * probabilities[std::min<std::size_t>(i, 63)]);
  free_form.curves = {histogram("samples", table_counts, 0, 1), steps};

  Findings findings;
  findings.sections = {discrete, angle, free_form};
  findings.checks = {
      counts_check("The running sums choose each event with its probability.", by_sums, events),
      counts_check("So does the table of aliases, in constant time.", by_aliases, events),
      counts_check("$\\theta = \\cos^{-1}\\sqrt{1-\\alpha}$ has the density $2\\sin\\theta\\cos\\theta$.", angle_counts,
                   cell_probabilities(angle_cdf, 0, pi / 2, 36)),
      counts_check("Samples of the table have its density.", table_counts, probabilities)};
  return findings;
}

}  // namespace

const Experiment inverse_cdf{
    .name = "inverse-cdf",
    .title = "Sampling by the inverse distribution function",
    .group = group_k,
    .question =
        "Does the inverse of a distribution function turn uniform random numbers into samples of its density: for a "
        "few events, for a density whose integral has an inverse, and for one that is only a table?",
    .formula =
        R"(x = F^{-1}(\alpha):\qquad P\Bigl(\alpha\in\bigl[\textstyle\sum_{j<i}p_j,\sum_{j\le i}p_j\bigr)\Bigr) = p_i,\qquad \theta = \cos^{-1}\sqrt{1-\alpha},\quad \phi = 2\pi\beta)",
    .source = "Rendering, figure 14.2 and equations 14.19 to 14.23 (whose second factor is F(φ) = φ/2π)",
    .fault = "the polar angle by the distribution function of the uniform hemisphere",
    .knobs = {{{"samples", 200000, "samples of each density"}}},
    .checks = 4,
    .run = run};

}  // namespace montelux::lab
