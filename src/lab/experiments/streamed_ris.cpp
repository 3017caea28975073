// R: resampling through a reservoir, when nobody knows how many candidates will come.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/resampling.h"

namespace montelux::lab {

namespace {

struct StreamedEstimate {
  std::uint32_t length;
  double value;
};

// Candidates come until a die says stop: one at least, and each further one with the probability 15/16.
StreamedEstimate estimate_from_stream(bool fault, RandomStream<float>& stream) {
  WeightedReservoir<double> reservoir;
  std::uint32_t length = 0;
  do {
    const double x = double(stream.next());
    reservoir.add(x, float(x * x), stream.next());
    ++length;
  } while (stream.next() < 15.0f / 16);
  // The planted fault divides by the number of candidates that come on average.
  const float count = fault ? 16.0f : reservoir.count;
  const float y = float(reservoir.value);
  return {length, 4 * std::pow(reservoir.value, 3) * double(resampling_weight(reservoir.weight_sum, count, y * y))};
}

Findings run(const Setup& setup) {
  const std::uint32_t many = setup.count("realisations");
  std::vector<double> all;
  std::vector<std::vector<double>> by_length(7);
  for (std::uint32_t r = 0; r < many; ++r) {
    RandomStream<float> stream = setup.stream(1, r);
    const StreamedEstimate e = estimate_from_stream(setup.fault(), stream);
    all.push_back(e.value);
    // Lengths 1, 2 to 3, 4 to 7, ...
    by_length[std::min<std::size_t>(6, std::size_t(std::log2(e.length)))].push_back(e.value);
  }
  Curve mean{"mean of the estimates", Mark::points, {}, {}, {}, {}}, variance{"variance", Mark::points, {}, {}, {}, {}};
  std::vector<double> z;
  for (std::size_t k = 0; k < by_length.size(); ++k) {
    if (by_length[k].size() < 100) continue;
    const Spread s = spread_of(by_length[k]);
    const double middle = std::pow(2.0, double(k)) * (k == 0 ? 1 : 1.4);
    mean.x.push_back(middle), mean.y.push_back(s.mean);
    mean.low.push_back(s.mean - s.mean_error), mean.high.push_back(s.mean + s.mean_error);
    variance.x.push_back(middle), variance.y.push_back(s.variance);
    variance.low.push_back(s.variance - s.variance_error), variance.high.push_back(s.variance + s.variance_error);
    z.push_back((s.mean - 1) / s.mean_error);
  }
  Findings findings;
  findings.sections = {Figure{"mean",
                              "The mean of the estimates by the length that the stream turned out to have.",
                              {"length of the stream", true, {}, {}},
                              {"mean", false, {}, {}},
                              {mean, function_curve(
                                         "true value 1", Mark::dashes, [](double) { return 1.0; }, 1, 90, true, 2)},
                              false},
                       Figure{"variance",
                              "Longer streams give better estimates, as if $M$ had been chosen beforehand (line).",
                              {"length of the stream", true, {}, {}},
                              {"variance", true, {}, {}},
                              {variance, function_curve(
                                             "theory for $M$ candidates", Mark::line,
                                             [](double m) { return 9.0 / 7 / m + (1 - 1 / m) / 15; }, 1, 90, true, 60)},
                              false}};
  findings.checks = {mean_check("The estimate is unbiased over all streams.", spread_of(all), 1),
                     deviations_check("It is unbiased whatever length the stream has had.", z)};
  return findings;
}

}  // namespace

const Experiment streamed_ris{
    .name = "streamed-ris",
    .title = "Resampling from a stream of unknown length",
    .group = group_r,
    .question =
        "A weighted reservoir keeps one candidate, the sum of weights and a count, and no more. Is that enough to "
        "estimate $\\int_0^1 4x^3\\,dx$ by resampling, if the number of candidates is only known at the end?",
    .formula =
        R"(\hat I = f(y)\,W,\qquad W = \frac1{g(y)}\cdot\frac1M\sum_{j=1}^M\frac{g(x_j)}{p(x_j)},\qquad M\text{ counted as they come})",
    .source = "Monte Carlo, RIS and reservoirs, combining weighted reservoir sampling with RIS",
    .fault = "the mean weight is taken over the expected number of candidates",
    .knobs = {{{"realisations", 200000, "streams"}}},
    .checks = 2,
    .run = run};

}  // namespace montelux::lab
