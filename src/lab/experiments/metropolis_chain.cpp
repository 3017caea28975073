// F, "Metropolis Sampling": a chain, its histogram, its memory and its start.
#include <cmath>
#include <numeric>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"

namespace montelux::lab {

namespace {

// Two bumps on [0, 1], not normalised: 6 x (1 - x) (1 - cos(4 pi x) / 2), say; its integral by quadrature.
double target(double x) {
  return x <= 0 || x >= 1 ? 0 : 6 * x * (1 - x) * (1 - 0.8 * std::cos(12.566370614359172 * x));
}

// One step: a small move, or with the probability `jump` a fresh uniform point. The planted fault accepts every move.
double step(double x, double jump, bool fault, RandomStream<float>& stream) {
  const bool far = double(stream.next()) < jump;
  const double y = far ? double(stream.next()) : x + 0.1 * (2 * double(stream.next()) - 1);
  const double u = double(stream.next());
  if (y <= 0 || y >= 1) return x;
  return fault || u * target(x) < target(y) ? y : x;
}

struct Chain {
  double start, start_weight, state;
};

// Autocorrelation of x along one long chain, up to some lag.
std::vector<double> autocorrelation(const Setup& setup, std::size_t lags) {
  RandomStream<float> stream = setup.stream(3);
  std::vector<double> states;
  double x = 0.3;
  for (int i = 0; i < 200000; ++i) states.push_back(x = step(x, setup["jump"], setup.fault(), stream));
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
  const std::uint32_t many = setup.count("chains"), steps = setup.count("steps");
  const double integral = quadrature(target, 0, 1, 64);
  const double truth = quadrature([](double x) { return x * target(x); }, 0, 1, 64) / integral;

  // All chains start near the left end, from a density that is not the target's: 2 (1 - x), say.
  std::vector<Chain> chains;
  for (std::uint32_t i = 0; i < many; ++i) {
    RandomStream<float> stream = setup.stream(1, i);
    const double x = 1 - std::sqrt(double(stream.next()));
    chains.push_back({x, target(x) / std::max(1e-12, 2 * (1 - x)), x});
  }
  Curve biased{"mean of $x$ over the chains", Mark::points, {}, {}, {}, {}};
  Curve weighted{"weighted by $g(x_0)/p(x_0)$", Mark::points, {}, {}, {}, {}};
  std::vector<double> z_weighted;
  Spread first{}, last{};
  double normalisation = 0, normalisation_error = 0;
  std::uint32_t time = 0, next = 1;
  std::vector<RandomStream<float>> streams;
  for (std::uint32_t i = 0; i < many; ++i) streams.push_back(setup.stream(2, i));
  for (; time <= steps; ++time) {
    if (time == 0 || time == next) {
      std::vector<double> plain, corrected, weights;
      for (const Chain& c : chains) {
        plain.push_back(c.state), weights.push_back(c.start_weight);
        // Its expectation is zero at every time: the weighted mean of x is the target's.
        corrected.push_back(c.start_weight * (c.state - truth));
      }
      const Spread s = spread_of(plain), w = spread_of(corrected), total = spread_of(weights);
      if (time == 0) first = s, normalisation = total.mean, normalisation_error = total.mean_error;
      last = s;
      const double shown = time == 0 ? 0.5 : time;
      biased.x.push_back(shown), biased.y.push_back(s.mean);
      biased.low.push_back(s.mean - s.mean_error), biased.high.push_back(s.mean + s.mean_error);
      const double ratio = truth + w.mean / total.mean, error = w.mean_error / total.mean;
      weighted.x.push_back(shown), weighted.y.push_back(ratio), weighted.low.push_back(ratio - error),
          weighted.high.push_back(ratio + error);
      z_weighted.push_back(w.mean / w.mean_error);
      if (time == next) next *= 2;
    }
    for (std::uint32_t i = 0; i < many; ++i)
      chains[i].state = step(chains[i].state, setup["jump"], setup.fault(), streams[i]);
  }
  std::vector<double> states;
  for (const Chain& c : chains) states.push_back(c.state);
  const auto counts = counts_in_cells(states, 0, 1, 40);
  std::vector<double> probabilities;
  for (int i = 0; i < 40; ++i) probabilities.push_back(quadrature(target, i / 40.0, (i + 1) / 40.0, 2) / integral);

  const std::vector<double> correlation = autocorrelation(setup, 120);
  Curve memory{"autocorrelation of $x$", Mark::line, {}, {}, {}, {}};
  double time_of_memory = 1;
  for (std::size_t lag = 0; lag < correlation.size(); ++lag) {
    memory.x.push_back(double(lag)), memory.y.push_back(correlation[lag]);
    if (lag > 0) time_of_memory += 2 * correlation[lag];
  }
  Findings findings;
  findings.sections = {
      Figure{"histogram",
             "Where the chains are after their last step, against the normalised target.",
             {"$x$", false, 0, 1},
             {"density", false, {}, {}},
             {histogram("states", counts, 0, 1),
              function_curve(
                  "target", Mark::line, [&](double x) { return target(x) / integral; }, 0, 1, false, 160)},
             false},
      Figure{"memory",
             "The autocorrelation along one chain.",
             {"lag", false, {}, {}},
             {"autocorrelation", false, {}, {}},
             {memory},
             false},
      Figure{"start",
             "The start-up bias: chains that start from a wrong density forget it slowly; weighted by "
             "$g(x_0)/p(x_0)$ they are unbiased from the first step on. (Step 0 stands at 1/2.)",
             {"step", true, {}, {}},
             {"mean of $x$", false, {}, {}},
             {biased, weighted,
              function_curve(
                  "true value", Mark::dashes, [&](double) { return truth; }, 0.5, steps, true, 2)},
             false},
      Text{"A sample in " + with_error(time_of_memory, 0) +
           " counts as independent (integrated autocorrelation time)."}};
  // The weighted means of one set of chains hang together; each is held against the level of all of them.
  double largest = 0;
  for (double z : z_weighted) largest = std::max(largest, std::abs(z));
  Check unbiased = z_check("Weighted by their starts, the chains are unbiased at every step.", largest, 1, 0);
  unbiased.statistic = "largest deviation " + with_error(largest, 0) + " standard errors over " +
                       std::to_string(z_weighted.size()) + " times";
  unbiased.p_value = std::min(1.0, unbiased.p_value * double(z_weighted.size()));
  findings.checks = {
      counts_check("After the last step the states have the density of the target.", counts, probabilities),
      mean_check("Their mean is that of the target.", last, truth),
      rejected(mean_check("At the start it is not: there is a start-up bias.", first, truth)), unbiased,
      z_check("The mean weight of the starts recovers the normalisation of the target.", normalisation,
              normalisation_error, integral)};
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
