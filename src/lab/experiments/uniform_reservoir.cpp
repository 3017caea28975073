// R: N elements out of a stream whose length nobody knows.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/resampling.h"

namespace montelux::lab {

namespace {

// The planted fault keeps the first elements and lets each later one in with a fixed chance.
std::vector<std::uint32_t> kept_of(std::uint32_t length, std::uint32_t capacity, bool fault,
                                   RandomStream<float>& stream) {
  if (!fault) {
    UniformReservoir<std::uint32_t> reservoir(capacity);
    for (std::uint32_t i = 0; i < length; ++i) reservoir.add(i, stream);
    return reservoir.kept();
  }
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < length; ++i) {
    if (kept.size() < capacity)
      kept.push_back(i);
    else if (stream.next() < 0.1f)
      kept[std::size_t(double(stream.next()) * capacity)] = i;
  }
  return kept;
}

Findings run(const Setup& setup) {
  const std::uint32_t many = setup.count("realisations"), capacity = setup.count("capacity");
  Figure figure{"kept",
                "How often each place of the stream was kept, with its standard error, for three lengths of the "
                "stream. Lines: $N/M$.",
                {"place in the stream", true, {}, {}},
                {"probability of being kept", true, {}, {}},
                {},
                false};
  Findings findings;
  std::uint32_t purpose = 1;
  for (std::uint32_t factor : {2u, 8u, 32u}) {
    const std::uint32_t length = factor * capacity;
    const double truth = double(capacity) / length;
    std::vector<double> counts(length);
    double pairs = 0;
    for (std::uint32_t r = 0; r < many; ++r) {
      RandomStream<float> stream = setup.stream(purpose, r);
      bool first = false, last = false;
      for (std::uint32_t place : kept_of(length, capacity, setup.fault(), stream)) {
        counts[place] += 1;
        first = first || place == 0, last = last || place == length - 1;
      }
      pairs += first && last;
    }
    ++purpose;
    // Choices without replacement hang together: this much makes their sum of squares a chi-square of length - 1.
    double chi_square = 0;
    Curve curve{"$M = " + std::to_string(length) + "$", Mark::points, {}, {}, {}, {}};
    for (std::uint32_t i = 0; i < length; ++i) {
      const double share = counts[i] / many, error = std::sqrt(truth * (1 - truth) / many);
      chi_square += std::pow((share - truth) / error, 2) * (length - 1) / length;
      curve.x.push_back(i + 1), curve.y.push_back(share), curve.low.push_back(share - error),
          curve.high.push_back(share + error);
    }
    figure.curves.push_back(curve);
    add_expected(figure, function_curve(
                             "$N/M$", Mark::line, [&](double) { return truth; }, 1, length, true, 2));
    const std::string where = " in a stream of " + std::to_string(length) + ".";
    Check kept = chi_square_check("Every element is kept with the probability $N/M$" + where, chi_square, length - 1);
    findings.checks.push_back(kept);
    const double both = truth * (capacity - 1) / (length - 1);
    findings.checks.push_back(z_check("The first and the last are kept together as often as any pair" + where,
                                      pairs / many, std::sqrt(both * (1 - both) / many), both));
  }
  findings.sections = {figure};
  return findings;
}

}  // namespace

const Experiment uniform_reservoir{
    .name = "reservoir",
    .title = "A reservoir out of a stream",
    .group = group_r,
    .question =
        "$N$ elements are to be chosen out of a stream that cannot be stored and whose length $M$ is not known "
        "beforehand. Is every element kept with the same probability, and every pair, whenever the stream ends?",
    .formula = R"(P(\text{kept}) = 1\cdot\frac{N}{N+1}\cdot\frac{N+1}{N+2}\cdots\frac{M-1}{M} = \frac NM)",
    .source = "Monte Carlo, RIS and reservoirs; Vitter 1985, algorithm R",
    .fault = "a later element comes in with a fixed chance of 1/10",
    .knobs = {{{"realisations", 10000, "streams of each length"}, {"capacity", 8, "N"}}},
    .checks = 6,
    .run = run};

}  // namespace montelux::lab
