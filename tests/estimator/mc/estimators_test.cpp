// Estimators against closed forms: the integral of 4 x^3 over [0, 1] is 1, and its variances are known.
#include <gtest/gtest.h>

#include "mc/confidence.h"
#include "mc/estimate.h"
#include "mc/mis.h"
#include "mc/power.h"
#include "mc/resampling.h"
#include "mc/roulette.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

const double level = sidak_level(family_level, 80);

double f(double x) { return 4 * x * x * x; }

// Density (n + 1) x^n on [0, 1].
struct Power {
  double n;
  double density(double x) const { return (n + 1) * std::pow(x, n); }
  Draw<double> sample(RandomStream<float>& stream) const {
    // Off zero, where the density is zero too.
    const double x = std::pow(double(stream.next()) + 0x1p-25, 1 / (n + 1));
    return {x, density(x)};
  }
};

// The variance of the primary estimator, from 400 sample variances of 400.
template <class Realise>
TestResult variance_test(Realise realise, double truth) {
  std::vector<double> variances;
  RandomStream<float> stream(5, 55);
  for (int i = 0; i < 400; ++i) {
    Moments m;
    for (int j = 0; j < 400; ++j) m.add(realise(stream));
    variances.push_back(m.variance());
  }
  return t_test(variances, truth);
}

TEST(Estimate, primary_estimators_of_4x3_have_mean_1_and_the_textbook_variances) {
  struct Case {
    double n, variance;
  };
  for (auto [n, variance] : {Case{0, 9.0 / 7}, {1, 1.0 / 3}}) {
    const Estimate e = estimate(f, Power{n}, 200000, RandomStream<float>(1, 2));
    EXPECT_GT(z_test(e.mean, e.standard_error, 1).p_value, level);
    EXPECT_LT(z_test(e.mean, e.standard_error, 1.02).p_value, level);
    const auto realise = [n = n](auto& stream) { return primary_estimate(f, Power{n}, stream); };
    EXPECT_GT(variance_test(realise, variance).p_value, level);
    EXPECT_LT(variance_test(realise, 1.05 * variance).p_value, level);
  }
  const Estimate perfect = estimate(f, Power{3}, 1000, RandomStream<float>(1, 2));
  EXPECT_NEAR(perfect.mean, 1, 1e-12);
  EXPECT_NEAR(perfect.standard_error, 0, 1e-12);
  const Estimate uniform = estimate(f, UniformInterval{0, 1}, 200000, RandomStream<float>(1, 2));
  EXPECT_GT(z_test(uniform.mean, uniform.standard_error, 1).p_value, level);
}

TEST(Estimate, a_density_that_does_not_integrate_to_one_is_caught) {
  struct Slip {
    Draw<double> sample(RandomStream<float>& stream) const {
      const auto [x, density] = Power{1}.sample(stream);
      return {x, 0.5 * density};  // p(x) = x in place of 2 x
    }
  };
  const Estimate e = estimate(f, Slip{}, 1000, RandomStream<float>(1, 2));
  EXPECT_LT(z_test(e.mean, e.standard_error, 1).p_value, level);
}

TEST(Estimate, mse_is_variance_plus_squared_bias_and_variance_falls_as_one_over_n) {
  std::vector<double> logs;
  for (std::uint64_t n : {1u, 10u, 100u}) {
    const auto realise = [n](RandomStream<float> stream) { return estimate(f, Power{0}, n, stream).mean; };
    const ErrorOfEstimator e = measure_error(realise, 1, 20000, 7);
    EXPECT_NEAR(e.mse, e.variance + e.bias * e.bias, 1e-9 * e.mse);
    EXPECT_GT(z_test(e.bias, e.bias_standard_error, 0).p_value, level);
    logs.push_back(std::log(e.variance));
    // The relative standard deviation of a variance from 20000 realisations is at most 2 percent for this kurtosis.
    EXPECT_NEAR(e.variance * double(n) / (9.0 / 7), 1, 0.08);
  }
  EXPECT_NEAR((logs[2] - logs[0]) / std::log(100.0), -1, 0.02);
  // An estimator with a bias of 0.01 shows it.
  const auto biased = [](RandomStream<float> stream) { return estimate(f, Power{0}, 100, stream).mean + 0.01; };
  const ErrorOfEstimator e = measure_error(biased, 1, 20000, 7);
  EXPECT_LT(z_test(e.bias, e.bias_standard_error, 0).p_value, level);
}

TEST(Estimate, running_estimates_end_at_the_estimate) {
  const auto means = running_estimates(f, Power{0}, 500, RandomStream<float>(3, 4));
  EXPECT_EQ(means.size(), 500u);
  EXPECT_DOUBLE_EQ(means.back(), estimate(f, Power{0}, 500, RandomStream<float>(3, 4)).mean);
}

TEST(Estimate, efficiency_does_not_hang_on_the_number_of_samples) {
  const Estimate few = estimate(f, Power{1}, 20000, RandomStream<float>(1, 2));
  const Estimate many = estimate(f, Power{1}, 500000, RandomStream<float>(3, 2));
  EXPECT_NEAR(efficiency(few, 20000) / efficiency(many, 500000), 1, 0.06);
  EXPECT_NEAR(efficiency(many, 500000), 3, 0.06);
}

TEST(Estimate, stratified_variance_is_the_mean_within_the_strata) {
  // F = 1/N sum of one sample of each stratum: variance 1/N^2 sum of the variances within the strata.
  const std::uint32_t n = 8;
  double truth = 0;
  for (std::uint32_t k = 0; k < n; ++k) {
    const double low = double(k) / n, high = double(k + 1) / n;
    const double mean = n * integrate([](double x) { return f(x); }, low, high, 1);
    truth += (n * integrate([](double x) { return f(x) * f(x); }, low, high, 1) - mean * mean) / (n * n);
  }
  std::vector<double> variances;
  for (std::uint32_t r = 0; r < 400; ++r) {
    const PointSet set{PointSetKind::stratified, 1000 + r, 0, n};
    const Estimate e = estimate_over_passes([](const Sampler<float>& s) { return f(double(s.get1(0))); }, set, 200);
    variances.push_back(e.standard_error * e.standard_error * 200);
  }
  EXPECT_GT(t_test(variances, truth).p_value, level);
  EXPECT_LT(t_test(variances, 1.03 * truth).p_value, level);
  EXPECT_LT(truth, 9.0 / 7 / n / 30);
}

TEST(Confidence, intervals_over_passes_cover_95_percent_for_every_point_set) {
  const auto integrand = [](const Sampler<float>& s) {
    const Vec2f u = s.get2(0);
    return std::exp(-double(u.x)) * (1 + double(u.y));
  };
  const double truth = (1 - std::exp(-1.0)) * 1.5;
  for (const NamedPointSet& entry : point_set_names) {
    double covered = 0, narrow = 0;
    const std::uint32_t trials = 2000;
    for (std::uint32_t r = 0; r < trials; ++r) {
      // Means of 16 points are near enough to normal for the interval of 16 passes.
      const Estimate e = estimate_over_passes(integrand, {entry.kind, r, 0, 16, 1, 1}, 16);
      const Interval wide = confidence_interval(e.mean, e.standard_error, double(e.count));
      const Interval thin = confidence_interval(e.mean, 0.8 * e.standard_error, double(e.count));
      covered += wide.low <= truth && truth <= wide.high;
      narrow += thin.low <= truth && truth <= thin.high;
    }
    EXPECT_GT(proportion_test(covered, trials, 0.95).p_value, level) << entry.name << " " << covered / trials;
    EXPECT_LT(proportion_test(narrow, trials, 0.95).p_value, level) << entry.name << " " << narrow / trials;
  }
}

// ---- several densities
// ------------------------------------------------------------------------------------------------

// One realisation of the multi-sample estimator of the integral of 4 x^3 with one sample of 1 and two of (n + 1) x^n.
double multiple_estimate(MisHeuristic heuristic, double n, RandomStream<float>& stream) {
  const Power techniques[2] = {{0}, {n}};
  const double counts[2] = {1, 2};
  double total = 0;
  for (std::size_t i = 0; i < 2; ++i)
    for (int k = 0; k < int(counts[i]); ++k) {
      const Draw<double> draw = techniques[i].sample(stream);
      const std::array<float, 2> products{float(counts[0] * techniques[0].density(draw.x)),
                                          float(counts[1] * techniques[1].density(draw.x))};
      total += double(mis_weight<float>(heuristic, products, i)) * f(draw.x) / (counts[i] * draw.density);
    }
  return total;
}

TEST(Mis, every_heuristic_is_unbiased) {
  for (const NamedMisHeuristic& entry : mis_heuristic_names) {
    Moments m;
    RandomStream<float> stream(1, 9);
    for (int i = 0; i < 200000; ++i) m.add(multiple_estimate(entry.heuristic, 8, stream));
    EXPECT_GT(z_test(m.mean, m.standard_error(), 1).p_value, level) << entry.name;
    EXPECT_LT(z_test(m.mean, m.standard_error(), 1.02).p_value, level) << entry.name;
  }
}

TEST(Mis, balance_heuristic_is_within_its_bound_of_every_other) {
  const auto variance = [](MisHeuristic heuristic) {
    Moments m;
    RandomStream<float> stream(2, 9);
    for (int i = 0; i < 100000; ++i) m.add(multiple_estimate(heuristic, 8, stream));
    return m.variance();
  };
  // Veach and Guibas 1995, theorem 1: V(balance) <= V(other) + (1 / min n_i - 1 / sum n_i) mu^2.
  const double balance = variance(MisHeuristic::balance);
  for (const NamedMisHeuristic& entry : mis_heuristic_names)
    EXPECT_LE(balance, variance(entry.heuristic) + 1 - 1.0 / 3) << entry.name;
}

// ---- resampling
// ---------------------------------------------------------------------------------------------------------

double target(double x) { return 5 * x * x; }  // not normalised

TEST(Resampling, is_unbiased_for_every_number_of_candidates_and_its_variance_falls) {
  for (bool one_pass : {false, true}) {
    double last = INFINITY;
    for (std::uint32_t candidates : {1u, 2u, 8u, 64u}) {
      Moments m;
      RandomStream<float> stream(candidates, 9);
      for (int i = 0; i < 20000; ++i)
        m.add(one_pass ? resampled_estimate_in_one_pass(f, target, Power{0}, {candidates, 2}, stream)
                       : resampled_estimate(f, target, Power{0}, {candidates, 2}, stream));
      EXPECT_GT(z_test(m.mean, m.standard_error(), 1).p_value, level) << candidates;
      EXPECT_LT(z_test(m.mean, m.standard_error(), 1.1).p_value, level) << candidates;
      EXPECT_LT(m.variance(), last);
      last = m.variance();
    }
    // Many candidates: what stays is the variance of f / g under the density g / 5 * 3, halved by N = 2:
    // E[(f/g)^2] (5/3)^2 - 1 = 16/25 * 3/5 * 25/9 - 1 = 1/15.
    EXPECT_NEAR(last, 1.0 / 30, 0.03);
  }
}

TEST(Reservoir, every_element_of_a_stream_is_kept_with_probability_n_over_m) {
  const int length = 60, capacity = 7;
  std::vector<double> kept(length), expected(length);
  RandomStream<float> stream(1, 17);
  const int trials = 20000;
  for (int t = 0; t < trials; ++t) {
    UniformReservoir<int> reservoir(capacity);
    for (int i = 0; i < length; ++i) reservoir.add(i, stream);
    EXPECT_EQ(reservoir.kept().size(), std::size_t(capacity));
    for (int i : reservoir.kept()) kept[std::size_t(i)] += 1;
  }
  // Kept elements of one trial exclude each other, which only makes the statistic smaller.
  for (double& e : expected) e = double(trials) * capacity / length;
  EXPECT_GT(chi_square_test(kept, expected).p_value, level);
  for (int i = 0; i < length; ++i)
    EXPECT_GT(proportion_test(kept[std::size_t(i)], trials, double(capacity) / length).p_value, level / length);
  // A reservoir that prefers its first elements by ten percent is caught.
  for (int i = 0; i < length; ++i) kept[std::size_t(i)] *= i < capacity ? 1.1 : 1;
  EXPECT_LT(chi_square_test(kept, expected).p_value, level);
}

const std::vector<float> weights{0, 1, 5, 0, 0.1f, 2, 9, 0, 3, 3};

template <class Choose>
TestResult choice_test(Choose choose, const std::vector<float>& w) {
  std::vector<double> observed(w.size()), expected(w.size());
  double sum = 0;
  for (float x : w) sum += double(x);
  RandomStream<float> stream(1, 17);
  const int trials = 100000;
  for (int t = 0; t < trials; ++t) observed[choose(stream)] += 1;
  for (std::size_t i = 0; i < w.size(); ++i) expected[i] = trials * double(w[i]) / sum;
  return chi_square_test(observed, expected);
}

WeightedReservoir<std::size_t> fill(std::size_t from, std::size_t to, RandomStream<float>& stream) {
  WeightedReservoir<std::size_t> r;
  for (std::size_t i = from; i < to; ++i) r.add(i, weights[i], stream.next());
  return r;
}

TEST(Reservoir, weighted_choice_is_in_proportion_to_the_weights_and_merging_keeps_it) {
  const auto one_stream = [](auto& s) { return fill(0, weights.size(), s).value; };
  const auto merged = [](auto& s) {
    auto a = fill(0, 3, s), b = fill(3, 4, s), c = fill(4, weights.size(), s);
    b.merge(c, s.next());
    b.merge(a, s.next());
    EXPECT_EQ(b.count, float(weights.size()));
    return b.value;
  };
  EXPECT_GT(choice_test(one_stream, weights).p_value, level);
  EXPECT_GT(choice_test(merged, weights).p_value, level);
  // Merging by the number of candidates in place of the sum of weights is caught.
  const auto wrongly_merged = [](auto& s) {
    auto a = fill(0, 3, s), b = fill(3, weights.size(), s);
    return s.next() * 10 < 3 ? a.value : b.value;
  };
  EXPECT_LT(choice_test(wrongly_merged, weights).p_value, level);
}

TEST(Reservoir, lanes_choose_as_floats_do) {
  using F = NativeFloats;
  RandomStream<F> stream(lane_index<F>(), Uint<F>(3u));
  WeightedReservoir<F, F> many;
  std::vector<WeightedReservoir<float>> ones(native_lanes);
  for (int i = 0; i < 50; ++i) {
    const F candidate = stream.next(), weight = stream.next(), u = stream.next();
    many.add(candidate, weight, u);
    for (int k = 0; k < native_lanes; ++k) ones[std::size_t(k)].add(lane(candidate, k), lane(weight, k), lane(u, k));
  }
  for (int k = 0; k < native_lanes; ++k) {
    EXPECT_EQ(lane(many.value, k), ones[std::size_t(k)].value);
    EXPECT_EQ(lane(many.weight_sum, k), ones[std::size_t(k)].weight_sum);
  }
}

TEST(Resampling, weight_turns_a_choice_into_an_estimator) {
  Moments m;
  RandomStream<float> stream(21, 9);
  for (int i = 0; i < 40000; ++i) {
    WeightedReservoir<double> r;
    for (int k = 0; k < 4; ++k) {
      const Draw<double> d = Power{1}.sample(stream);
      r.add(d.x, float(target(d.x) / d.density), stream.next());
    }
    m.add(f(r.value) * double(resampling_weight(r.weight_sum, r.count, float(target(r.value)))));
  }
  EXPECT_GT(z_test(m.mean, m.standard_error(), 1).p_value, level);
  EXPECT_LT(z_test(m.mean, m.standard_error(), 1.05).p_value, level);
}

// ---- roulette
// -----------------------------------------------------------------------------------------------------------

TEST(Roulette, keeps_the_expectation) {
  for (float q : {0.05f, 0.5f, 0.95f, 1.0f, 2.0f}) {
    Moments fair, unweighted;
    RandomStream<float> stream(1, 5);
    for (int i = 0; i < 200000; ++i) {
      const double y = f(double(stream.next()));
      const Roulette<float> r = roulette(q, stream.next());
      fair.add(y * double(r.weight));
      unweighted.add(r.survives ? y : 0);
    }
    EXPECT_GT(z_test(fair.mean, fair.standard_error(), 1).p_value, level) << q;
    if (q < 1) {
      EXPECT_LT(z_test(unweighted.mean, unweighted.standard_error(), 1).p_value, level) << q;
    }
  }
  EXPECT_FALSE(roulette(0.0f, 0.0f).survives);
}

}  // namespace
}  // namespace montelux
