// Integrals as expectations: the primary estimator f(X) / p(X), the secondary estimator that averages it, and their
// quality. A distribution is any type with `sample(RandomStream<float>&) const` that returns a Draw.
#pragma once
#include <vector>

#include "mc/density.h"
#include "mc/moments.h"
#include "mc/point_set.h"

namespace montelux {

// A point and the density it was drawn with, in the measure of the integral.
template <class X>
struct Draw {
  X x;
  double density;
};

// Uniform on [low, high).
struct UniformInterval {
  double low = 0, high = 1;
  Draw<double> sample(RandomStream<float>& stream) const {
    return {low + (high - low) * double(stream.next()), 1 / (high - low)};
  }
};

// A distribution from a map of the unit square and the density of its points: any pair `sample_...` and `..._density`.
template <class Map, class DensityFunction>
struct MappedSquare {
  Map map;                  // Vec2f -> X
  DensityFunction density;  // X -> Density<Measure>
  auto sample(RandomStream<float>& stream) const {
    const auto x = map(stream.next2());
    return Draw<decltype(map(Vec2f{}))>{x, double(density(x).value)};
  }
};
template <class Map, class DensityFunction>
MappedSquare(Map, DensityFunction) -> MappedSquare<Map, DensityFunction>;

// One realisation of f(X) / p(X), whose expectation is the integral of f where p is not zero.
template <class Function, class Distribution>
double primary_estimate(Function f, const Distribution& distribution, RandomStream<float>& stream) {
  const auto draw = distribution.sample(stream);
  return double(f(draw.x)) / draw.density;
}

// The mean of n independent primary estimators.
template <class Function, class Distribution>
Estimate estimate(Function f, const Distribution& distribution, std::uint64_t n, RandomStream<float> stream) {
  Moments moments;
  for (std::uint64_t i = 0; i < n; ++i) moments.add(primary_estimate(f, distribution, stream));
  return moments.estimate();
}

// The estimates after 1, 2, ..., n primary estimators of one realisation.
template <class Function, class Distribution>
std::vector<double> running_estimates(Function f, const Distribution& distribution, std::uint64_t n,
                                      RandomStream<float> stream) {
  Moments moments;
  std::vector<double> means;
  for (std::uint64_t i = 0; i < n; ++i) {
    moments.add(primary_estimate(f, distribution, stream));
    means.push_back(moments.mean);
  }
  return means;
}

// f(const Sampler<float>&) averaged over the points of each pass; the error bar comes from the spread of the passes, so
// it is valid for every point set.
template <class Function>
Estimate estimate_over_passes(Function f, PointSet set, std::uint32_t passes) {
  Moments over_passes;
  for (std::uint32_t pass = 0; pass < passes; ++pass, ++set.pass) {
    Moments in_pass;
    for (std::uint32_t i = 0; i < set.samples_per_pass; ++i) in_pass.add(double(f(Sampler<float>(set, 0u, 0u, i))));
    over_passes.non_finite += in_pass.non_finite;
    if (in_pass.count > 0) over_passes.add(in_pass.mean);
  }
  return over_passes.estimate();
}

// 1 / (variance x cost) of an estimate that cost this much (seconds, evaluations, ...): the same for every number of
// samples, so it compares estimators (Hammersley and Handscomb 1964, section 5.1).
inline double efficiency(const Estimate& e, double cost) { return 1 / (e.standard_error * e.standard_error * cost); }

// The errors of an estimator, measured over independent realisations: mse = variance + bias^2.
struct ErrorOfEstimator {
  double bias, bias_standard_error;
  double variance, mse;
  std::uint64_t realisations;
};

// `realise(RandomStream<float>)` is one realisation of the estimator, from a stream of its own.
template <class Realise>
ErrorOfEstimator measure_error(Realise realise, double truth, std::uint32_t realisations, std::uint32_t seed) {
  Moments moments, squares;
  for (std::uint32_t i = 0; i < realisations; ++i) {
    const double value = realise(RandomStream<float>(i, mix_bits(seed + 0x1f83d9abu)));
    moments.add(value);
    squares.add((value - truth) * (value - truth));
  }
  // The population variance of the realisations, so that the identity with the mse holds exactly.
  const double variance = moments.m2 / double(moments.count);
  return {moments.mean - truth, moments.standard_error(), variance, squares.mean, moments.count};
}

}  // namespace montelux
