// F, "Metropolis Sampling": a chain, its histogram, its memory and its start.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/metropolis.h"

namespace montelux::lab {

namespace {

// Two bumps on [0, 1], not normalised; its integrals by quadrature.
double target(double x) {
  return x <= 0 || x >= 1 ? 0 : 6 * x * (1 - x) * (1 - 0.8 * std::cos(4 * std::numbers::pi * x));
}
double target_integral(double low, double high) { return quadrature(target, low, high, 64); }
double target_mean() {
  return quadrature([](double x) { return x * target(x); }, 0, 1, 64) / target_integral(0, 1);
}

// A small move, or with the probability `jump` to a fresh uniform point. The planted fault accepts every move.
struct Mutation {
  double jump;
  bool fault;

  double operator()(double x, RandomStream<float>& stream) const {
    const bool far = double(stream.next()) < jump;
    const double y = far ? double(stream.next()) : x + 0.1 * (2 * double(stream.next()) - 1);
    const double u = double(stream.next());
    if (y <= 0 || y >= 1) return x;
    return fault || u < metropolis_acceptance(target(x), target(y)) ? y : x;
  }
};

// Many chains side by side. They start from 2 (1 - x), near the left end, which is not the target's density; each has
// the weight of the target over that density at its start.
struct Ensemble {
  std::vector<double> states, weights;
  std::vector<RandomStream<float>> streams;

  explicit Ensemble(const Setup& setup) {
    for (std::uint32_t i = 0; i < setup.count("chains"); ++i) {
      const double x = 1 - std::sqrt(double(setup.stream(1, i).at(0u)));
      states.push_back(x), weights.push_back(target(x) / std::max(1e-12, 2 * (1 - x)));
      streams.push_back(setup.stream(2, i));
    }
  }
  void step(const Mutation& mutate) {
    for (std::size_t i = 0; i < states.size(); ++i) states[i] = mutate(states[i], streams[i]);
  }
};

// The mean of x over the chains by number of steps, plain and weighted by their starts.
struct History {
  Curve plain{"mean of $x$ over the chains", Mark::points, {}, {}, {}, {}};
  Curve weighted{"weighted by $g(x_0)/p(x_0)$", Mark::points, {}, {}, {}, {}};
  std::vector<Spread> plain_spreads;
  std::vector<double> z_weighted;

  void record(const Ensemble& chains, double time, double truth) {
    const Spread s = spread_of(chains.states), normalisation = spread_of(chains.weights);
    plain_spreads.push_back(s);
    add(plain, time, s.mean, s.mean_error);
    // Its expectation is zero at every time: the weighted mean of x is the target's.
    std::vector<double> deviations;
    for (std::size_t i = 0; i < chains.states.size(); ++i)
      deviations.push_back(chains.weights[i] * (chains.states[i] - truth));
    const Spread w = spread_of(deviations);
    add(weighted, time, truth + w.mean / normalisation.mean, w.mean_error / normalisation.mean);
    z_weighted.push_back(w.mean / w.mean_error);
  }

 private:
  // Step 0 is shown at 1/2, where a logarithmic axis has a place for it.
  static void add(Curve& curve, double time, double value, double error) {
    curve.x.push_back(std::max(0.5, time)), curve.y.push_back(value);
    curve.low.push_back(value - error), curve.high.push_back(value + error);
  }
};

// Autocorrelation of x along one long chain, up to some lag.
std::vector<double> autocorrelation(RandomStream<float> stream, const Mutation& mutate, std::size_t lags) {
  std::vector<double> states;
  double x = 0.3;
  for (int i = 0; i < 200000; ++i) states.push_back(x = mutate(x, stream));
  const double mean = std::accumulate(states.begin(), states.end(), 0.0) / double(states.size());
  std::vector<double> correlation;
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < states.size(); ++i) sum += (states[i] - mean) * (states[i + lag] - mean);
    correlation.push_back(sum / (correlation.empty() ? 1 : correlation[0]));
  }
  correlation[0] = 1;
  return correlation;
}

Findings run(const Setup& setup) {
  const std::uint32_t steps = setup.count("steps");
  const Mutation mutate{setup["jump"], setup.fault()};
  const double integral = target_integral(0, 1), truth = target_mean();
  Ensemble chains(setup);
  const Spread normalisation = spread_of(chains.weights);
  History history;
  history.record(chains, 0, truth);
  for (std::uint32_t time = 1; time <= steps; ++time) {
    chains.step(mutate);
    if (std::has_single_bit(time) || time == steps) history.record(chains, time, truth);
  }

  const auto counts = counts_in_cells(chains.states, 0, 1, 40);
  std::vector<double> probabilities;
  for (int i = 0; i < 40; ++i) probabilities.push_back(target_integral(i / 40.0, (i + 1) / 40.0) / integral);
  Figure histogram_of_states{"histogram",
                             "Where the chains are after their last step, against the normalised target.",
                             {"$x$", false, 0, 1},
                             {"density", false, {}, {}},
                             {histogram("states", counts, 0, 1)},
                             false};
  histogram_of_states.curves.push_back(function_curve(
      "target", Mark::line, [&](double x) { return target(x) / integral; }, 0, 1, false, 160));

  Curve memory{"autocorrelation of $x$", Mark::line, {}, {}, {}, {}};
  double time_of_memory = 1;
  for (double c : autocorrelation(setup.stream(3), mutate, 120)) {
    if (!memory.x.empty()) time_of_memory += 2 * c;
    memory.x.push_back(double(memory.x.size())), memory.y.push_back(c);
  }
  const Curve level = function_curve(
      "true value", Mark::dashes, [&](double) { return truth; }, 0.5, steps, true, 2);
  Findings findings;
  findings.sections = {histogram_of_states,
                       Figure{"memory",
                              "The autocorrelation along one chain.",
                              {"lag", false, {}, {}},
                              {"autocorrelation", false, {}, {}},
                              {memory},
                              false},
                       Table{"independence",
                             "How many samples of one chain count as one that is independent.",
                             {"integrated autocorrelation time"},
                             {{time_of_memory}}},
                       Figure{"start",
                              "The start-up bias: chains that start from a wrong density forget it slowly; weighted by "
                              "$g(x_0)/p(x_0)$ they are unbiased from the first step on. (Step 0 stands at 1/2.)",
                              {"step", true, {}, {}},
                              {"mean of $x$", false, {}, {}},
                              {history.plain, history.weighted, level},
                              false}};
  findings.checks = {
      counts_check("After the last step the states have the density of the target.", counts, probabilities),
      mean_check("Their mean is that of the target.", history.plain_spreads.back(), truth),
      rejected(mean_check("At the start it is not: there is a start-up bias.", history.plain_spreads.front(), truth)),
      largest_deviation_check("Weighted by their starts, the chains are unbiased at every step.", history.z_weighted,
                              "times"),
      z_check("The mean weight of the starts recovers the normalisation of the target.", normalisation.mean,
              normalisation.mean_error, integral)};
  return findings;
}

}  // namespace

const Experiment metropolis_chain{
    .name = "metropolis",
    .title = "A Metropolis chain",
    .group = group_f,
    .question =
        "A chain of small moves, accepted by the ratio of an unnormalised target $g$, visits points in proportion to "
        "it. "
        "Do its states have the target's density, how long does it remember, and what does a bad start do to its "
        "means?",
    .formula =
        R"(a(x\to y) = \min\Bigl(1,\frac{g(y)}{g(x)}\Bigr),\qquad E\Bigl[\frac{g(x_0)}{p(x_0)}\,h(x_t)\Bigr] = \int h(x)\,g(x)\,dx\ \text{ for every } t)",
    .source =
        "COS 526, Variance Reduction Techniques; Metropolis et al. 1953; Veach 1997, section 11.3.1 (start-up bias)",
    .fault = "every move is accepted",
    .knobs = {{{"chains", 20000, "independent chains"},
               {"steps", 512, "of each chain"},
               {"jump", 0.05, "probability of a fresh point"}}},
    .checks = 5,
    .run = run};

}  // namespace montelux::lab
