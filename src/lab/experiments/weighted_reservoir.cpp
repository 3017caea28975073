// R: one element out of a stream, in proportion to its weight.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/resampling.h"

namespace montelux::lab {

namespace {

// Light and heavy weights in no order, one of them zero.
constexpr std::array<double, 20> weights{3, 0.2, 7, 1, 12, 0, 5, 2, 0.5, 9, 4, 1, 6, 0.1, 8, 2, 3, 10, 1, 5};

std::uint32_t choose(bool fault, RandomStream<float>& stream) {
  WeightedReservoir<std::uint32_t> reservoir;
  double seen = 0;
  for (std::uint32_t i = 0; i < weights.size(); ++i) {
    // The planted fault forgets the element's own weight in the sum of those so far.
    const float u = stream.next();
    if (fault && double(u) * std::max(seen, 1e-9) < weights[i]) reservoir.value = i;
    if (!fault) reservoir.add(i, float(weights[i]), u);
    seen += weights[i];
  }
  return reservoir.value;
}

Findings run(const Setup& setup) {
  const std::uint32_t many = setup.count("realisations");
  double sum = 0;
  for (double w : weights) sum += w;
  std::vector<double> counts(weights.size()), probabilities;
  for (double w : weights) probabilities.push_back(w / sum);
  for (std::uint32_t r = 0; r < many; ++r) {
    RandomStream<float> stream = setup.stream(1, r);
    counts[choose(setup.fault(), stream)] += 1;
  }
  Figure figure{"chosen",
                "How often each element of the stream was the last one left, against its share of the weights.",
                {"place in the stream", false, {}, {}},
                {"probability", false, {}, {}},
                {},
                false};
  Curve truth{"$w_i / \\sum w$", Mark::points, {}, probabilities, {}, {}};
  for (std::size_t i = 0; i < weights.size(); ++i) truth.x.push_back(double(i + 1));
  figure.curves = {histogram("chosen", counts, 0.5, double(weights.size()) + 0.5), truth};
  Findings findings;
  findings.sections = {figure};
  findings.checks = {counts_check("Each element is chosen in proportion to its weight.", counts, probabilities),
                     exact_check("An element of weight zero is never chosen.", counts[5] == 0, "in all streams")};
  return findings;
}

}  // namespace

const Experiment weighted_reservoir{
    .name = "weighted-reservoir",
    .title = "A weighted reservoir",
    .group = group_r,
    .question =
        "One element is chosen out of a stream in one pass and constant memory: each newcomer takes the place with the "
        "probability of its share of the weights so far. Does each element win with its share of all weights?",
    .formula =
        R"(P(x_i\text{ wins}) = \frac{w_i}{\sum_{k\le i}w_k}\prod_{j>i}\frac{\sum_{k\le j-1}w_k}{\sum_{k\le j}w_k} = \frac{w_i}{\sum_k w_k})",
    .source = "Monte Carlo, RIS and reservoirs; Chao 1982",
    .fault = "the newcomer's own weight is missing in the sum",
    .knobs = {{{"realisations", 200000, "streams"}}},
    .checks = 2,
    .run = run};

}  // namespace montelux::lab
