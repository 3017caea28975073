// What makes a result less than it claims, and that it is said.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "doubtful.h"
#include "lab/integral/diagnosis.h"
#include "lab/integral/sampled.h"
#include "lab/integral/singularity.h"
#include "mc/cube_points.h"
#include "statistics.h"

namespace montelux::lab {
namespace {

using namespace montelux::test;
using enum IntegralWarning::Kind;

Method method_named(std::string_view text) { return parse_method(text).value(); }

TEST(Doubt, two_peaks_far_apart_are_both_found_or_the_doubt_is_said) {
  const KnownIntegral f = two_gaussians(0.05);
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const IntegralResult r =
        integrate({.integrand = f.integrand}, method_named("auto"), {.samples = 1u << 18}, {.seed = seed});
    const Interval wide = result_of(r.state, 0.9999).interval;
    EXPECT_TRUE((wide.low <= f.truth && f.truth <= wide.high) || !r.warnings.empty()) << seed << ": " << r.mean;
    // The fault: half of it.
    EXPECT_FALSE(wide.low <= 0.5 * f.truth && 0.5 * f.truth <= wide.high) << seed;
  }
}

// Of two equal peaks on the diagonal a product of maps finds one crossing in 2^(d-1); a map of bins does no better.
TEST(Doubt, a_map_that_cannot_follow_the_integrand_is_doubted) {
  const auto run = [](const Integrand& f) {
    return integrate({.integrand = f}, method_named("qmc:adapt=true"), {.samples = 1u << 18}, {.seed = 3});
  };
  for (std::size_t dimension : {4, 5}) {
    const IntegralResult r = run(two_gaussians(0.05, dimension).integrand);
    const double best = std::pow(0.5, double(dimension) - 1);
    EXPECT_LE(*r.map_worth, best);
    EXPECT_GE(*r.map_worth, 0.6 * best);
    EXPECT_TRUE(warns(r, map_fit));
    const IntegralResult read_again = result_of(state_from_json(to_json(r.state)));
    EXPECT_EQ(*read_again.map_worth, *r.map_worth);
  }
  const auto one_peak = [](const double* x) { return gaussian(x, 3, 0.4, 0.05); };
  // Values of both signs: it is their magnitude that the map follows.
  const auto signed_peak = [&](const double* x) { return x[0] < 0.41 ? -one_peak(x) : one_peak(x); };
  for (const Integrand& f : {Integrand{3, pointwise(one_peak)}, Integrand{3, pointwise(signed_peak)}}) {
    const IntegralResult r = run(f);
    EXPECT_GT(*r.map_worth, 0.6);
    EXPECT_FALSE(warns(r, map_fit));
  }
}

// A run of eight passes whose uniform points and whose map find these masses outside of the map.
IntegralState run_with_outside(double uniform, double spread, double map) {
  IntegralState state;
  state.method = method_named("qmc:adapt=true");
  for (std::uint32_t i = 0; i < 8; ++i) {
    const double found = uniform + spread * (i % 2 == 0 ? 1 : -1);
    PassRecord p{0, i, 100, 100.0 * (1 + 1e-3 * i), 1};
    p.outside = {100 * found, 100 * map, 100 * std::abs(found), 100 * std::abs(map)};
    state.passes.push_back(p);
  }
  state.largest.add(2.0);
  return state;
}

TEST(Doubt, mass_outside_of_the_map_is_reported_and_counted) {
  const IntegralResult plain = result_of(run_with_outside(0.02, 0.01, 0.02));
  EXPECT_FALSE(plain.outside_map->missed);
  EXPECT_FALSE(warns(plain, outside_map));
  // Many points that agree with each other, and a few that cannot be chance.
  for (const IntegralState& state : {run_with_outside(0.5, 0.01, 0.02), run_with_outside(0.5, 0.5, 1e-5)}) {
    const IntegralResult r = result_of(state);
    EXPECT_TRUE(r.outside_map->missed);
    EXPECT_TRUE(warns(r, outside_map));
    EXPECT_NEAR(r.mean - plain.mean, 0.5 - r.outside_map->by_map, 1e-12);
  }
}

TEST(Doubt, samples_that_are_all_zero_give_no_interval) {
  const Problem zero{.integrand = {2, pointwise([](const double*) { return 0.0; })}};
  for (const char* text : {"auto", "uniform", "vegas", "miser", "qmc", "metropolis"}) {
    const IntegralResult r = integrate(zero, method_named(text), {.samples = 10000});
    EXPECT_TRUE(r.found_nothing && warns(r, nothing_found)) << text;
    EXPECT_FALSE(std::isfinite(r.standard_error) || std::isfinite(r.interval.low) || std::isfinite(r.interval.high))
        << text;
  }
  for (bool relative : {false, true}) {
    std::string note;
    double fraction = 0;
    const IntegralResult r =
        integrate(zero, method_named("uniform"), {.target_error = 1e-3, .target_is_relative = relative},
                  {.observer = [&](const IntegralProgress& p) { note = p.note, fraction = p.fraction; }});
    EXPECT_EQ(r.stopped_because, StopReason::nothing_found);
    EXPECT_FALSE(r.target_reached);
    EXPECT_NE(note.find("no sample has found anything"), std::string::npos);
    EXPECT_GT(fraction, 0.2);
  }
}

TEST(Doubt, a_constant_has_the_error_of_rounding_and_no_warning) {
  for (double value : {3.0, 6e-16, -0.1}) {
    const Problem constant{.integrand = {1, pointwise([value](const double*) { return value; })}};
    for (const char* text : {"auto", "uniform", "vegas", "miser"}) {
      const IntegralResult r = integrate(constant, method_named(text), {.samples = 1u << 16});
      EXPECT_TRUE(r.warnings.empty()) << text << " " << value << ": " << r.warnings.front().message;
      EXPECT_GT(r.standard_error, 0);
      EXPECT_LE(r.interval.low, value);
      EXPECT_GE(r.interval.high, value);
    }
  }
  const Problem three{.integrand = {2, pointwise([](const double*) { return 3.0; })}};
  EXPECT_EQ(integrate(three, method_named("auto"), {.samples = 1u << 16}).mean, 3.0);
  EXPECT_EQ(integrate(three, method_named("uniform"), {.target_error = 1e-30}).stopped_because, StopReason::rounding);
}

TEST(Doubt, estimates_that_disagree_are_named) {
  const std::vector<NamedEstimate> agree{{"a", 1.0, 0.01, 7}, {"b", 1.03, 0.01, 31}, {"c", 1.02, 0.001, 5}};
  EXPECT_TRUE(disagreements_of(agree).empty());
  const std::vector<NamedEstimate> differ{{"a", 1.0, 0.01, 7}, {"b", 0.5, 1e-5, 7}, {"c", 1.0, INFINITY, 7}};
  const auto found = disagreements_of(differ);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].first + found[0].second, "ab");
  EXPECT_NEAR(found[0].difference, 0.5, 1e-12);
}

TEST(Doubt, a_wrong_integral_of_the_control_variate_is_found) {
  Problem p{.integrand = {1, pointwise([](const double* x) { return std::exp(x[0]); })}};
  for (double integral : {0.5, 0.51}) {
    p.control = ControlVariate{pointwise([](const double* x) { return x[0]; }), integral};
    const IntegralResult r = integrate(p, method_named("control"), {.samples = 1u << 16});
    EXPECT_EQ(warns(r, control_integral), integral != 0.5) << integral;
  }
}

TEST(Doubt, infinite_variance_is_said_and_an_integral_that_may_not_exist) {
  for (const char* text : {"auto", "uniform", "qmc"})
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      const auto run = [&](const KnownIntegral& f) {
        return integrate({.integrand = f.integrand}, method_named(text), {.samples = 1u << 18}, {.seed = seed});
      };
      for (const KnownIntegral& f : infinite_variance())
        EXPECT_TRUE(warns(run(f), heavy_tail)) << text << " " << f.name;
      for (const KnownIntegral& f : divergent()) EXPECT_TRUE(warns(run(f), may_not_exist)) << text << " " << f.name;
      for (const KnownIntegral& f : well_behaved()) {
        const IntegralResult r = run(f);
        EXPECT_FALSE(warns(r, heavy_tail) || warns(r, may_not_exist)) << text << " " << f.name;
      }
    }
}

TEST(Singularity, the_growth_is_measured_and_a_narrow_peak_is_no_singularity) {
  const auto probe = [](std::size_t dimension, auto f) { return probe_tail({dimension, pointwise(f)}, 1, 1u << 15); };
  const TailProbe root = probe(2, [](const double* x) { return 1 / std::sqrt(std::abs(x[0] - x[1])); });
  EXPECT_NEAR(root.exponent, 0.5, 1e-3);
  EXPECT_NEAR(root.index, 2, 0.01);
  const TailProbe point = probe(3, [](const double* x) {
    return 1 / (std::pow(x[0] - 0.3, 2) + std::pow(x[1] - 0.4, 2) + std::pow(x[2] - 0.7, 2));
  });
  EXPECT_NEAR(point.exponent, 2, 0.01);
  EXPECT_NEAR(point.index, 1.5, 0.01);
  for (double sigma : {1e-1, 1e-2, 1e-4}) {
    const TailProbe peak = probe(2, [sigma](const double* x) { return gaussian(x, 2, 0.4, sigma); });
    EXPECT_EQ(peak.exponent, 0) << sigma;
    EXPECT_TRUE(peak.known && std::isinf(peak.index)) << sigma;
  }
}

TEST(Budgets, a_run_of_any_size_stops_soon) {
  const Problem f{.integrand = {2, pointwise([](const double* x) { return x[0]; })}};
  for (const char* text :
       {"uniform", "stratified", "stratified:strata=latin", "qmc", "vegas", "miser", "auto", "metropolis"}) {
    int polls = 0;
    const IntegralResult r = integrate(f, method_named(text), {.samples = std::uint64_t(1e15)},
                                       {.threads = 1, .stop = [&] { return ++polls > 3; }});
    EXPECT_EQ(r.stopped_because, StopReason::stopped) << text;
    EXPECT_LE(polls, 5) << text;
  }
  EXPECT_THROW(integrate(f, method_named("uniform:passes=2"), {.samples = std::uint64_t(1e12)}), std::invalid_argument);
}

TEST(States, a_state_that_no_run_can_have_is_refused) {
  const Problem f{.integrand = {1, pointwise([](const double* x) { return x[0]; })}};
  const IntegralState state = integrate(f, method_named("qmc:adapt=true"), {.samples = 10000}).state;
  const nlohmann::json good = nlohmann::json::parse(to_json(state));
  EXPECT_EQ(to_json(state_from_json(good.dump())), to_json(state));
  const auto refused = [&](const char* path, const nlohmann::json& value) {
    nlohmann::json bad = good;
    bad[nlohmann::json::json_pointer(path)] = value;
    EXPECT_THROW(state_from_json(bad.dump()), std::invalid_argument) << path << " " << value.dump();
  };
  refused("/passes/0/2", 1e38), refused("/passes/0/2", 0), refused("/passes/0/2", std::uint64_t(1) << 40);
  refused("/passes/0/1", std::uint64_t(1) << 32), refused("/passes/0/3", "much"), refused("/passes/0/4", -1);
  refused("/passes/0", nlohmann::json::array({1, 2})), refused("/evaluations", -5), refused("/evaluations", 1);
  refused("/dimension", 1e9), refused("/looks", 1e300), refused("/training_samples", 1e18);
  refused("/seconds", -1), refused("/largest_terms/0", nullptr), refused("/probe", 7);
}

TEST(AdaptiveMap, states_its_density_at_any_point) {
  const KnownIntegral f = two_gaussians(0.05, 3);
  MapTraining training(f.integrand, 1, 20000);
  training.go_to(MapTraining::steps);
  constexpr std::size_t n = 1000;
  std::vector<double> points(3 * n), jacobian(n, 1.0), density(n);
  fill_independent(CubeKey::of(4, 2), {3, 0, n, points.data()});
  training.map().apply(points, jacobian);
  training.map().density(points, density);
  for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(density[i] * jacobian[i], 1, 1e-8);
}

}  // namespace
}  // namespace montelux::lab
