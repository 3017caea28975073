// Reservoirs that are handed between domains: the mean is right by every unbiased way to share, and off by naive shares
// by what theory says.
#include "mc/reuse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "mc/reuse_group.h"
#include "statistics.h"

namespace montelux::test {
namespace {

// The integral of f over [0, 1], asked by domain 0. Domain 1 cannot make samples below 0.3; domain 2 counts its samples
// in the square of x, and cannot make any above 0.8.
template <class F>
struct Intervals {
  static F target(int domain, F own) {
    if (domain == 0) return select(own < F(0.9f), own + 0.5f, F(0.0f));
    if (domain == 1) return select(own > F(0.3f), 2.0f * own, F(0.0f));
    return select(own < F(0.64f), F(1.5f) - own, F(0.0f));
  }
  Shifted<F, F> shift(int from, const F& value, Mask<F>) const {
    if (from == 1) return {value, F(1.0f), target(0, value)};
    const F x = sqrt(value);
    return {x, F(0.5f) / max(x, F(1e-6f)), target(0, x)};
  }
  F target_at(int to, const F& x, Mask<F>) const { return to == 2 ? target(2, x * x) * 2.0f * x : target(to, x); }
};
template <class F>
F integrand(F x) {
  return select(x < F(0.9f), x * x + 0.2f, F(0.0f));
}
double antiderivative(double x) { return x * x * x / 3 + 0.2 * x; }
double between(double a, double b) { return antiderivative(b) - antiderivative(a); }
const double truth = between(0, 0.9);
constexpr float confidences[3] = {1, 2, 4};
// Each domain has its part by its share of the confidence, wherever it can make samples.
const double naive_mean = (1 * truth + 2 * between(0.3, 0.9) + 4 * between(0, 0.8)) / 7;

// A reservoir of few candidates, uniform in the domain's own measure.
template <class F>
Reservoir<F, F> first_reservoir(int domain, RandomStream<F>& stream) {
  constexpr int candidates = 3;
  WeightedReservoir<F, F> chosen;
  for (int i = 0; i < candidates; ++i) {
    const F x = stream.next(), u = stream.next();
    chosen.add(x, Intervals<F>::target(domain, x) * (1.0f / candidates), u);
  }
  const F target = Intervals<F>::target(domain, chosen.value);
  return {chosen.value, resampling_weight(chosen.weight_sum, F(1.0f), target), F(confidences[domain]), target};
}

template <class F>
F realisation(ReuseWeights weights, RandomStream<F> stream, std::array<int, 2> order = {1, 2}) {
  struct Ordered {
    Intervals<F> domains;
    std::array<int, 3> number;
    Shifted<F, F> shift(int from, const F& value, Mask<F> on) const {
      return domains.shift(number[std::size_t(from)], value, on);
    }
    F target_at(int to, const F& value, Mask<F> on) const {
      return domains.target_at(number[std::size_t(to)], value, on);
    }
  };
  const Ordered domains{{}, {0, order[0], order[1]}};
  std::array<Reservoir<F, F>, 3> inputs;
  for (std::size_t i = 0; i < 3; ++i) inputs[i] = first_reservoir<F>(domains.number[i], stream);
  const Reservoir<F, F> r = combine<F, F>(weights, inputs, domains, stream, Mask<F>(true));
  return integrand(r.value) * r.weight;
}

std::vector<double> realisations(ReuseWeights weights, int count, std::uint32_t seed,
                                 std::array<int, 2> order = {1, 2}) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i)
    values.push_back(double(realisation<float>(weights, RandomStream<float>(seed, std::uint32_t(i)), order)));
  return values;
}

TEST(Reuse, finds_the_integral_by_every_unbiased_share) {
  for (ReuseWeights weights : {ReuseWeights::unbiased, ReuseWeights::pairwise, ReuseWeights::generalised}) {
    EXPECT_GT(t_test(realisations(weights, 200000, 1), truth).p_value, sidak_level(family_level, 7));
    EXPECT_GT(t_test(realisations(weights, 200000, 2, {2, 1}), truth).p_value, sidak_level(family_level, 7));
  }
}

TEST(Reuse, by_naive_shares_is_off_by_what_the_other_domains_cannot_make) {
  const std::vector<double> values = realisations(ReuseWeights::naive, 200000, 3);
  EXPECT_GT(t_test(values, naive_mean).p_value, sidak_level(family_level, 7));
  EXPECT_LT(t_test(values, truth).p_value, 1e-12);
}

// The sum over all inputs: the mean of the sample that is chosen, with less variance.
struct SumOfAll {
  float own_value = 0, sum = 0;
  void own(float weight, bool on) { sum += on ? integrand(own_value) * weight : 0; }
  void other(const Shifted<float, float>& image, float weight, bool on) {
    sum += on ? integrand(image.value) * weight : 0;
  }
};
std::vector<double> sums_of_all(ReuseWeights weights, int count, std::uint32_t seed) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    RandomStream<float> stream(seed, std::uint32_t(i));
    std::array<Reservoir<float, float>, 3> inputs;
    for (int domain = 0; domain < 3; ++domain) inputs[std::size_t(domain)] = first_reservoir<float>(domain, stream);
    SumOfAll all{inputs[0].value};
    combine<float, float>(weights, inputs, Intervals<float>{}, stream, true, all);
    values.push_back(double(all.sum));
  }
  return values;
}

TEST(Reuse, the_sum_over_all_inputs_finds_the_integral_with_less_variance) {
  for (ReuseWeights weights : {ReuseWeights::pairwise, ReuseWeights::generalised}) {
    ASSERT_TRUE(shares_sum_to_one(weights));
    const std::vector<double> sums = sums_of_all(weights, 200000, 21);
    EXPECT_GT(t_test(sums, truth).p_value, sidak_level(family_level, 2));
    EXPECT_LT(summarize(sums).variance, 0.9 * summarize(realisations(weights, 200000, 22)).variance);
  }
}

// Shares that only add up for the sample that is chosen do not serve sums.
TEST(Reuse, the_sum_over_all_inputs_is_off_by_confidence_alone) {
  ASSERT_FALSE(shares_sum_to_one(ReuseWeights::unbiased));
  EXPECT_LT(t_test(sums_of_all(ReuseWeights::unbiased, 200000, 23), truth).p_value, 1e-12);
}

// The same domains as a group, whose maps compose. A fault: no Jacobian.
template <class F, bool has_jacobian = true>
struct IntervalGroup {
  Shifted<F, F> own(int of, const F& value, Mask<F> on) const { return image(of, of, value, on); }
  Shifted<F, F> image(int from, int to, const F& value, Mask<F>) const {
    const F x = from == 2 ? sqrt(value) : value, y = to == 2 ? x * x : x;
    F jacobian = 1.0f;
    if (from == 2 && to != 2) jacobian = F(0.5f) / max(x, F(1e-6f));
    if (from != 2 && to == 2) jacobian = 2.0f * x;
    return {y, has_jacobian ? jacobian : F(1.0f), Intervals<F>::target(to, y)};
  }
};
// Replaces the reservoirs of the group by what their domains have chosen.
template <class F, bool has_jacobian = true, class Each>
void share_in_group(std::span<Reservoir<F, F>> group, const RandomStream<F>& stream, Each&& each) {
  const IntervalGroup<F, has_jacobian> domains;
  const std::vector<Reservoir<F, F>> before(group.begin(), group.end());
  const auto choices = combine_group(std::span(before), domains, stream, Mask<F>(true), each);
  for (std::size_t k = 0; k < group.size(); ++k) {
    const auto& choice = choices[k];
    const Mask<F> found = choice.weight > F(0.0f);
    for_each_lane(found, [&](int j) {
      const int from = int(lane(choice.from, j));
      EXPECT_EQ(lane(domains.image(from, int(k), before[std::size_t(from)].value, found).value, j),
                lane(choice.image.value, j));
    });
    group[k] = {select(found, choice.image.value, before[k].value), choice.weight, choice.confidence,
                choice.image.target};
  }
}
// Of all x: what a domain cannot make has weight 0.
template <class F>
F integrand_of_group(F x) {
  return x * x + 0.2f;
}
const std::array<double, 3> truths_of_group{between(0, 0.9), between(0.3, 1), between(0, 0.64)};

// By the samples that are chosen, and by the sums over all.
template <class F>
struct GroupEstimates {
  std::array<F, 3> chosen, sum;
};
template <class F, bool has_jacobian = true>
GroupEstimates<F> of_group(RandomStream<F> stream) {
  std::array<Reservoir<F, F>, 3> group;
  for (int domain = 0; domain < 3; ++domain) group[std::size_t(domain)] = first_reservoir<F>(domain, stream);
  GroupEstimates<F> e;
  e.sum.fill(F(0.0f));
  share_in_group<F, has_jacobian>(group, stream.fork(Uint<F>(1u)),
                                  [&](std::size_t k, const Shifted<F, F>& image, const F& weight, Mask<F> on) {
                                    e.sum[k] = e.sum[k] + select(on, integrand_of_group(image.value) * weight, F(0.0f));
                                  });
  for (std::size_t k = 0; k < 3; ++k) {
    e.chosen[k] = integrand_of_group(group[k].value) * group[k].weight;
    EXPECT_TRUE(all(group[k].confidence == F(7.0f)));
  }
  return e;
}

struct GroupSamples {
  std::array<std::vector<double>, 3> chosen, sum;
};
template <bool has_jacobian>
GroupSamples samples_of_group(std::uint32_t seed) {
  GroupSamples s;
  for (std::uint32_t i = 0; i < 200000; ++i) {
    const GroupEstimates<float> e = of_group<float, has_jacobian>(RandomStream<float>(seed, i));
    for (std::size_t k = 0; k < 3; ++k)
      s.chosen[k].push_back(double(e.chosen[k])), s.sum[k].push_back(double(e.sum[k]));
  }
  return s;
}

TEST(ReuseGroup, finds_the_integral_over_each_of_its_domains) {
  const GroupSamples s = samples_of_group<true>(31);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GT(t_test(s.chosen[k], truths_of_group[k]).p_value, sidak_level(family_level, 6)) << k;
    EXPECT_GT(t_test(s.sum[k], truths_of_group[k]).p_value, sidak_level(family_level, 6)) << k;
    EXPECT_LT(summarize(s.sum[k]).variance, summarize(s.chosen[k]).variance) << k;
  }
}

TEST(ReuseGroup, without_the_jacobian_is_off_in_each_of_its_domains) {
  const GroupSamples s = samples_of_group<false>(32);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LT(t_test(s.chosen[k], truths_of_group[k]).p_value, 1e-9) << k;
    EXPECT_LT(t_test(s.sum[k], truths_of_group[k]).p_value, 1e-9) << k;
  }
}

TEST(ReuseGroup, has_the_bits_of_single_reservoirs_in_lanes) {
  using F = NativeFloats;
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const GroupEstimates<F> pack = of_group<F>(RandomStream<F>(Uint<F>(seed), lane_index<F>()));
    for (int k = 0; k < lanes_of<F>; ++k) {
      const GroupEstimates<float> one = of_group<float>(RandomStream<float>(seed, std::uint32_t(k)));
      for (std::size_t domain = 0; domain < 3; ++domain) {
        EXPECT_EQ(lane(pack.chosen[domain], k), one.chosen[domain]);
        EXPECT_EQ(lane(pack.sum[domain], k), one.sum[domain]);
      }
    }
  }
}

TEST(Reuse, lanes_have_the_bits_of_single_reservoirs) {
  using F = NativeFloats;
  for (ReuseWeights weights :
       {ReuseWeights::naive, ReuseWeights::unbiased, ReuseWeights::pairwise, ReuseWeights::generalised})
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
      const F pack = realisation<F>(weights, RandomStream<F>(Uint<F>(seed), lane_index<F>()));
      for (int k = 0; k < lanes_of<F>; ++k)
        EXPECT_EQ(lane(pack, k), realisation<float>(weights, RandomStream<float>(seed, std::uint32_t(k))));
    }
}

// Domains of the group as one of them, number 0, sees them.
struct SeenFromFirst {
  std::array<int, 4> number;
  IntervalGroup<float> group = {};
  Shifted<float, float> shift(int from, const float& x, bool on) const {
    return group.image(number[std::size_t(from)], number[0], x, on);
  }
  float target_at(int to, const float& x, bool on) const {
    const Shifted<float, float> there = group.image(number[0], number[std::size_t(to)], x, on);
    return there.target * there.jacobian;
  }
};

// In every frame each domain combines what is new there with what all of them have kept of the frame before. By domain,
// means over the frames of chains.
std::array<std::vector<double>, 3> means_of_chains(ReuseWeights weights, std::uint32_t count, std::uint32_t seed) {
  constexpr int frames = 8;
  std::array<std::vector<double>, 3> means;
  for (std::uint32_t i = 0; i < count; ++i) {
    RandomStream<float> stream(seed, i);
    std::array<Reservoir<float, float>, 3> kept;
    for (int domain = 0; domain < 3; ++domain) kept[std::size_t(domain)] = first_reservoir<float>(domain, stream);
    std::array<double, 3> sums{};
    for (int frame = 0; frame < frames; ++frame) {
      for (Reservoir<float, float>& r : kept) r.confidence = std::min(r.confidence, 5.0f);
      const auto before = kept;
      for (int domain = 0; domain < 3; ++domain) {
        const SeenFromFirst domains{{domain, domain, (domain + 1) % 3, (domain + 2) % 3}};
        std::array<Reservoir<float, float>, 4> inputs{first_reservoir<float>(domain, stream)};
        for (std::size_t k = 1; k < 4; ++k) inputs[k] = before[std::size_t(domains.number[k])];
        const auto r = combine<float, float>(weights, inputs, domains, stream, true);
        sums[std::size_t(domain)] += double(integrand_of_group(r.value) * r.weight);
        kept[std::size_t(domain)] = r;
      }
    }
    for (std::size_t domain = 0; domain < 3; ++domain) means[domain].push_back(sums[domain] / frames);
  }
  return means;
}

// What combinations promise for later ones: the weight serves every function on the domain that they are for.
TEST(Reuse, chains_of_combinations_stay_unbiased) {
  for (ReuseWeights weights : {ReuseWeights::unbiased, ReuseWeights::pairwise, ReuseWeights::generalised}) {
    const auto means = means_of_chains(weights, 20000, 11);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_GT(t_test(means[k], truths_of_group[k]).p_value, sidak_level(family_level, 9)) << int(weights) << " " << k;
  }
}

TEST(Reuse, chains_of_combinations_by_naive_shares_are_off_in_each_domain) {
  const auto means = means_of_chains(ReuseWeights::naive, 20000, 12);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(t_test(means[k], truths_of_group[k]).p_value, 1e-12) << k;
}

TEST(Reuse, takes_what_is_not_a_usable_number_for_nothing_found) {
  constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const Intervals<float> domains;
  for (ReuseWeights weights :
       {ReuseWeights::naive, ReuseWeights::unbiased, ReuseWeights::pairwise, ReuseWeights::generalised})
    for (float bad : {0.0f, inf, nan, 3e38f, -1.0f}) {
      RandomStream<float> stream(5, 6);
      const float x = 0.5f, t = Intervals<float>::target(0, x), t1 = Intervals<float>::target(1, x);
      const Reservoir<float, float> good{x, 2, 1, t};
      // In the place of the first, and of another.
      const Reservoir<float, float> a[2] = {good, {0.7f, bad, 1, t1}}, b[2] = {{0.7f, bad, 1, t}, {x, 2, 1, t1}};
      for (const auto& inputs : {a, b}) {
        const Reservoir<float, float> r = combine<float, float>(weights, std::span(inputs, 2), domains, stream, true);
        EXPECT_EQ(r.value, x) << int(weights) << " " << bad;
        EXPECT_TRUE(r.weight > 0 && r.weight <= 2) << int(weights) << " " << bad << " " << r.weight;
        EXPECT_EQ(r.confidence, 2);
      }
      const Reservoir<float, float> nothing[2] = {{x, bad, 1, t}, {x, bad, 1, t1}};
      EXPECT_EQ((combine<float, float>(weights, nothing, domains, stream, true).weight), 0);
    }
}

// One sample of use, in the place of each domain in turn.
TEST(ReuseGroup, takes_what_is_not_a_usable_number_for_nothing_found) {
  constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const std::array<float, 3> images{0.5f, 0.5f, 0.25f};
  const auto reservoir = [](int domain, float value, float weight) {
    return Reservoir<float, float>{value, weight, 1, Intervals<float>::target(domain, value)};
  };
  const auto combine_all = [](std::array<Reservoir<float, float>, 3>& group) {
    share_in_group<float>(group, RandomStream<float>(5, 6),
                          [](std::size_t k, const Shifted<float, float>&, float weight, bool on) {
                            EXPECT_TRUE(!on || (weight > 0 && weight <= 2)) << k << " " << weight;
                          });
  };
  for (float bad : {0.0f, inf, nan, 3e38f, -1.0f}) {
    std::array<Reservoir<float, float>, 3> nothing;
    for (int domain = 0; domain < 3; ++domain) nothing[std::size_t(domain)] = reservoir(domain, 0.6f, bad);
    for (int good = 0; good < 3; ++good) {
      std::array<Reservoir<float, float>, 3> group = nothing;
      group[std::size_t(good)] = reservoir(good, images[std::size_t(good)], 2);
      combine_all(group);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(group[k].value, images[k]) << good << " " << bad << " " << k;
        EXPECT_TRUE(group[k].weight > 0 && group[k].weight <= 2) << good << " " << bad << " " << group[k].weight;
        EXPECT_EQ(group[k].confidence, 3);
      }
    }
    combine_all(nothing);
    for (const Reservoir<float, float>& r : nothing) EXPECT_EQ(r.weight, 0) << bad;
  }
}

TEST(Reuse, confidence_adds_up_and_zero_is_not_there) {
  const Intervals<float> domains;
  RandomStream<float> stream(7, 8);
  const float t = Intervals<float>::target(0, 0.5f), t1 = Intervals<float>::target(1, 0.5f);
  const Reservoir<float, float> inputs[3] = {{0.5f, 1, 3, t}, {0.5f, 1, 4, t1}, {0.4f, 9, 0, 1}};
  for (ReuseWeights weights : {ReuseWeights::unbiased, ReuseWeights::pairwise, ReuseWeights::generalised}) {
    const auto r = combine<float, float>(weights, inputs, domains, stream, true);
    EXPECT_EQ(r.confidence, 7);
    EXPECT_EQ(r.value, 0.5f);
    EXPECT_NEAR(r.weight, 1, 1e-6);
  }
}

// A domain whose confidence is no number, or so large that its products would be none, is not there; the others share
// as if it were not asked.
TEST(Reuse, takes_what_is_not_a_usable_confidence_for_none) {
  constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const Intervals<float> domains;
  const float x = 0.5f, t = Intervals<float>::target(0, x), t1 = Intervals<float>::target(1, x);
  for (float bad : {0.0f, inf, nan, 3e38f, 1e13f, -1.0f}) {
    for (ReuseWeights weights :
         {ReuseWeights::naive, ReuseWeights::unbiased, ReuseWeights::pairwise, ReuseWeights::generalised}) {
      RandomStream<float> stream(5, 6);
      const Reservoir<float, float> a[2] = {{x, 2, 3, t}, {0.7f, 5, bad, 1}}, b[2] = {{0.7f, 5, bad, 1}, {x, 2, 3, t1}};
      for (const auto& inputs : {a, b}) {
        const Reservoir<float, float> r = combine<float, float>(weights, std::span(inputs, 2), domains, stream, true);
        EXPECT_EQ(r.value, x) << int(weights) << " " << bad;
        EXPECT_NEAR(r.weight, 2, 1e-6) << int(weights) << " " << bad;
        EXPECT_EQ(r.confidence, 3) << int(weights) << " " << bad;
      }
    }
    std::array<Reservoir<float, float>, 3> group{{{x, 2, 3, t}, {0.7f, 5, bad, 1.4f}, {0.6f, 5, bad, 0.9f}}};
    share_in_group<float>(group, RandomStream<float>(5, 6),
                          [&](std::size_t k, const Shifted<float, float>&, float weight, bool on) {
                            EXPECT_TRUE(!on || (k == 0 && weight == 2)) << bad << " " << k << " " << weight;
                          });
    EXPECT_EQ(group[0].value, x) << bad;
    EXPECT_NEAR(group[0].weight, 2, 1e-6) << bad;
    EXPECT_EQ(group[0].confidence, 3) << bad;
    for (std::size_t k : {1u, 2u}) EXPECT_EQ(group[k].confidence, 0) << bad << " " << k;
  }
}

// Whatever the confidences are, as long as they do not depend on the samples: only their ratios count.
TEST(Reuse, finds_the_integral_by_huge_and_tiny_confidences) {
  constexpr int count = 100000;
  const float scales[][3] = {{1e12f, 1e12f, 1e12f}, {1e-12f, 1e-12f, 1e-12f}, {1, 1e6f, 1e-6f}};
  const double own = sidak_level(family_level, double(std::size(scales) * (2 + 3)));
  for (const auto& scale : scales) {
    const auto inputs_of = [&](std::uint32_t i, RandomStream<float>& stream) {
      std::array<Reservoir<float, float>, 3> inputs;
      stream = RandomStream<float>(31, i);
      for (int domain = 0; domain < 3; ++domain) {
        inputs[std::size_t(domain)] = first_reservoir<float>(domain, stream);
        inputs[std::size_t(domain)].confidence = scale[domain];
      }
      return inputs;
    };
    RandomStream<float> stream(0, 0);
    for (ReuseWeights weights : {ReuseWeights::pairwise, ReuseWeights::generalised}) {
      std::vector<double> values;
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto inputs = inputs_of(i, stream);
        const auto r = combine<float, float>(weights, inputs, Intervals<float>{}, stream, true);
        values.push_back(double(integrand(r.value) * r.weight));
      }
      EXPECT_GT(t_test(values, truth).p_value, own) << int(weights) << " " << scale[1];
    }
    std::array<std::vector<double>, 3> of_group;
    for (std::uint32_t i = 0; i < count; ++i) {
      auto group = inputs_of(i, stream);
      share_in_group<float>(group, stream.fork(1), [](std::size_t, const Shifted<float, float>&, float, bool) {});
      for (std::size_t k = 0; k < 3; ++k)
        of_group[k].push_back(double(integrand_of_group(group[k].value) * group[k].weight));
    }
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_GT(t_test(of_group[k], truths_of_group[k]).p_value, own) << k << " " << scale[1];
  }
}

// ---- reservoirs of one stream
// -----------------------------------------------------------------------------------------

constexpr float stream_weights[8] = {0, 1, 2, 3, 0.5f, 0, 6, 1e-3f};

std::vector<double> choices(int parts, bool reversed, int count) {
  std::vector<double> observed(8, 0.0);
  for (int n = 0; n < count; ++n) {
    RandomStream<float> stream(std::uint32_t(parts + (reversed ? 100 : 0)), std::uint32_t(n));
    WeightedReservoir<int> whole;
    for (int part = 0; part < parts; ++part) {
      WeightedReservoir<int> one;
      for (int i = part; i < 8; i += parts) {
        const int element = reversed ? 7 - i : i;
        one.add(element, stream_weights[element], stream.next());
      }
      whole.merge(one, stream.next());
    }
    EXPECT_EQ(whole.count, 8);
    EXPECT_NEAR(whole.weight_sum, 12.501, 1e-4);
    observed[std::size_t(whole.value)] += 1;
  }
  return observed;
}

TEST(WeightedReservoir, merges_of_parts_in_any_order_choose_as_one_long_stream) {
  constexpr int count = 100000;
  std::vector<double> expected;
  for (float w : stream_weights) expected.push_back(count * double(w) / 12.501);
  for (int parts : {1, 2, 4, 8})
    for (bool reversed : {false, true}) {
      const std::vector<double> observed = choices(parts, reversed, count);
      EXPECT_GT(chi_square_test(observed, expected).p_value, sidak_level(family_level, 9)) << parts << reversed;
      EXPECT_EQ(observed[0] + observed[5], 0);
    }
  std::vector<double> off = expected;
  off[6] *= 1.02, off[3] -= 0.02 * expected[6];
  EXPECT_LT(chi_square_test(choices(4, false, count), off).p_value, 1e-3);
}

}  // namespace
}  // namespace montelux::test
