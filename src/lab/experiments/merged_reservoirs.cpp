// R: reservoirs of several streams merged, against one long stream.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/resampling.h"

namespace montelux::lab {

namespace {

// Four streams of these lengths; element i of all has the weight 1 + i mod 7.
constexpr std::array<std::uint32_t, 4> lengths{2, 5, 9, 16};
constexpr std::uint32_t total = 32;
double weight(std::uint32_t i) { return 1 + i % 7; }

using Reservoir = WeightedReservoir<std::uint32_t>;

Reservoir one_stream(RandomStream<float>& stream) {
  Reservoir reservoir;
  for (std::uint32_t i = 0; i < total; ++i) reservoir.add(i, float(weight(i)), stream.next());
  return reservoir;
}

// The planted fault counts each reservoir alike when it merges them.
Reservoir merged(bool fault, RandomStream<float>& stream) {
  Reservoir all;
  std::uint32_t i = 0;
  for (std::uint32_t length : lengths) {
    Reservoir part;
    for (std::uint32_t k = 0; k < length; ++k, ++i) part.add(i, float(weight(i)), stream.next());
    if (fault) part.weight_sum = 1;
    all.merge(part, stream.next());
  }
  return all;
}

Findings run(const Setup& setup) {
  const std::uint32_t many = setup.count("realisations");
  std::vector<double> long_counts(total), merged_counts(total), probabilities(total);
  double sum = 0;
  for (std::uint32_t i = 0; i < total; ++i) sum += weight(i);
  for (std::uint32_t i = 0; i < total; ++i) probabilities[i] = weight(i) / sum;
  bool sums_agree = true;
  for (std::uint32_t r = 0; r < many; ++r) {
    RandomStream<float> a = setup.stream(1, r), b = setup.stream(2, r);
    long_counts[one_stream(a).value] += 1;
    const Reservoir all = merged(setup.fault(), b);
    merged_counts[all.value] += 1;
    sums_agree = sums_agree && all.count == total && (setup.fault() || double(all.weight_sum) == sum);
  }
  Figure figure{"chosen",
                "How often each element won: in one long stream, and in four streams merged.",
                {"element", false, {}, {}},
                {"probability", false, {}, {}},
                {},
                false};
  Curve truth{"$w_i / \\sum w$", Mark::points, {}, probabilities, {}, {}};
  for (std::uint32_t i = 0; i < total; ++i) truth.x.push_back(i + 1);
  figure.curves = {histogram("one stream", long_counts, 0.5, total + 0.5),
                   histogram("merged", merged_counts, 0.5, total + 0.5), truth};
  // Compares two samples of equal size.
  double chi_square = 0;
  for (std::uint32_t i = 0; i < total; ++i)
    chi_square += std::pow(long_counts[i] - merged_counts[i], 2) / (long_counts[i] + merged_counts[i]);
  Findings findings;
  findings.sections = {figure};
  findings.checks = {counts_check("One long stream chooses in proportion to the weights.", long_counts, probabilities),
                     counts_check("Four merged streams do so too.", merged_counts, probabilities),
                     chi_square_check("The two are indistinguishable.", chi_square, total - 1),
                     exact_check("The merged reservoir knows the sum of all weights and how many elements were seen.",
                                 sums_agree, "in every realisation")};
  return findings;
}

}  // namespace

const Experiment merged_reservoirs{
    .name = "merging",
    .title = "Merging reservoirs",
    .group = group_r,
    .question =
        "Reservoirs of several streams are merged by choosing among their elements with the weights of their sums. Is "
        "that the same as one reservoir that has read all streams?",
    .formula =
        R"(P(x_i) = \frac{w_i}{W_s}\cdot\frac{W_s}{\sum_t W_t} = \frac{w_i}{\sum_t W_t},\qquad W_s = \sum_{i\in s}w_i)",
    .source = "Monte Carlo, RIS and reservoirs",
    .fault = "merged reservoirs count alike, whatever their weights",
    .knobs = {{{"realisations", 200000, "merged reservoirs"}}},
    .checks = 4,
    .run = run};

}  // namespace montelux::lab
