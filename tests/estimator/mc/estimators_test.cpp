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
SampleSummary primary_variance(Realise realise) {
  RandomStream<float> stream(5, 55);
  return variance_summary([&](std::uint32_t) { return realise(stream); }, 160000, 400);
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
    const SampleSummary measured = primary_variance(realise);
    EXPECT_GT(t_test(measured, variance).p_value, level);
    EXPECT_LT(t_test(measured, 1.05 * variance).p_value, level);
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

// The bias and the variance of an estimator, each as a mean over 50 batches of 400 realisations.
struct MeasuredError {
  SampleSummary bias, variance;
};
template <class Realise>
MeasuredError error_in_batches(Realise realise) {
  std::vector<double> bias, variance;
  for (std::uint32_t batch = 0; batch < 50; ++batch) {
    const ErrorOfEstimator e = measure_error(realise, 1, 400, 7 + batch);
    EXPECT_NEAR(e.mse, e.variance + e.bias * e.bias, 1e-9 * e.mse);
    // Of the population of 400 realisations; without bias it is larger.
    bias.push_back(e.bias), variance.push_back(e.variance * 400 / 399);
  }
  return {summarize(bias), summarize(variance)};
}

TEST(Estimate, mse_is_variance_plus_squared_bias_and_variance_falls_as_one_over_n) {
  const auto mean_of = [](std::uint64_t n, RandomStream<float> stream) {
    return estimate(f, Power{0}, n, stream).mean;
  };
  std::vector<SampleSummary> variances;
  for (std::uint64_t n : {1u, 10u, 100u}) {
    const MeasuredError e = error_in_batches([&](RandomStream<float> stream) { return mean_of(n, stream); });
    EXPECT_GT(t_test(e.bias, 0).p_value, level);
    EXPECT_GT(t_test(e.variance, 9.0 / 7 / double(n)).p_value, level);
    EXPECT_LT(t_test(e.variance, 1.06 * 9.0 / 7 / double(n)).p_value, level);
    variances.push_back(e.variance);
  }
  const Exponent slope = measured_exponent(variances[0], variances[2], 100);
  EXPECT_GT(z_test(slope.value, slope.standard_error, -1).p_value, level) << slope.value;
  // An estimator that uses every twentieth number twice is caught in the slope, one with a bias of 0.01 in its bias.
  const auto careless = error_in_batches([&](RandomStream<float> stream) {
    const double first = mean_of(10, stream);
    return 0.1 * first + 0.9 * mean_of(90, stream);
  });
  const Exponent wrong = measured_exponent(variances[0], careless.variance, 100);
  EXPECT_LT(z_test(wrong.value, wrong.standard_error, -1).p_value, level) << wrong.value;
  const auto biased = error_in_batches([&](RandomStream<float> stream) { return mean_of(100, stream) + 0.01; });
  EXPECT_LT(t_test(biased.bias, 0).p_value, level);
}

TEST(Estimate, running_estimates_end_at_the_estimate) {
  const auto means = running_estimates(f, Power{0}, 500, RandomStream<float>(3, 4));
  EXPECT_EQ(means.size(), 500u);
  EXPECT_DOUBLE_EQ(means.back(), estimate(f, Power{0}, 500, RandomStream<float>(3, 4)).mean);
}

TEST(Estimate, efficiency_does_not_depend_on_the_number_of_samples) {
  // One over the efficiency is the variance of the primary estimator, 1/3, without bias for any number of samples.
  const auto inverse_efficiencies = [](std::uint64_t n, double cost, std::uint32_t seed) {
    std::vector<double> all;
    for (std::uint32_t i = 0; i < 200; ++i)
      all.push_back(1 / efficiency(estimate(f, Power{1}, n, RandomStream<float>(i, seed)), cost));
    return summarize(all);
  };
  const SampleSummary few = inverse_efficiencies(100, 100, 2), many = inverse_efficiencies(2500, 2500, 3);
  EXPECT_GT(t_test(few, 1.0 / 3).p_value, level);
  EXPECT_GT(t_test(many, 1.0 / 3).p_value, level);
  EXPECT_GT(welch_test(few, many).p_value, level);
  // A cost that counts one evaluation in twelve twice is caught.
  const SampleSummary wrong = inverse_efficiencies(2500, 2500 * 13.0 / 12, 3);
  EXPECT_LT(t_test(wrong, 1.0 / 3).p_value, level);
  EXPECT_LT(welch_test(few, wrong).p_value, level);
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
      const Estimate e = estimate_over_passes(integrand, {entry.kind, r, 0, 16}, 16);
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
  const auto variance = [](auto realise) {
    RandomStream<float> stream(2, 9);
    return variance_summary([&](std::uint32_t) { return realise(stream); }, 100000);
  };
  const auto of = [&](MisHeuristic heuristic) {
    return variance([=](auto& stream) { return multiple_estimate(heuristic, 8, stream); });
  };
  // Veach and Guibas 1995, theorem 1: V(balance) <= V(other) + (1 / min n_i - 1 / sum n_i) mu^2. Proven, not only not
  // refuted.
  const auto breaks_bound = [](const SampleSummary& tested, const SampleSummary& other) {
    return at_least_p_value(tested.mean - other.mean, std::hypot(tested.standard_error(), other.standard_error()),
                            1 - 1.0 / 3);
  };
  const SampleSummary balance = of(MisHeuristic::balance);
  for (const NamedMisHeuristic& entry : mis_heuristic_names)
    EXPECT_LT(breaks_bound(balance, of(entry.heuristic)), level) << entry.name;
  // All weight on the one uniform sample is unbiased too, and farther than the bound from the balance heuristic.
  const SampleSummary uniform = variance([](auto& stream) { return primary_estimate(f, Power{0}, stream); });
  EXPECT_GT(breaks_bound(uniform, balance), 1 - level) << uniform.mean << " against " << balance.mean;
}

// ---- resampling
// ---------------------------------------------------------------------------------------------------------

double target(double x) { return 5 * x * x; }  // not normalised

TEST(Resampling, is_unbiased_for_every_number_of_candidates_and_its_variance_falls) {
  for (bool one_pass : {false, true})
    for (std::uint32_t candidates : {1u, 2u, 8u, 64u}) {
      Moments m;
      RandomStream<float> stream(candidates, 9);
      const SampleSummary variance = variance_summary(
          [&](std::uint32_t) {
            const double value = one_pass ? resampled_estimate_in_one_pass(f, target, Power{0}, {candidates, 2}, stream)
                                          : resampled_estimate(f, target, Power{0}, {candidates, 2}, stream);
            m.add(value);
            return value;
          },
          20000);
      EXPECT_GT(z_test(m.mean, m.standard_error(), 1).p_value, level) << candidates;
      EXPECT_LT(z_test(m.mean, m.standard_error(), 1.1).p_value, level) << candidates;
      // Law of total variance, given the M candidates: their mean of f / p has the variance 9/7 / M, and each of the
      // N = 2 choices among them adds E[w] E[f^2 / g] - 1 = 5/3 * 16/25 - 1 = 1/15 as far as they are not one.
      const double truth = 9.0 / 7 / candidates + (1 - 1.0 / candidates) / 15 / 2;
      EXPECT_GT(t_test(variance, truth).p_value, level) << candidates << ": " << variance.mean << " for " << truth;
      EXPECT_LT(t_test(variance, 1.1 * truth).p_value, level) << candidates;
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
