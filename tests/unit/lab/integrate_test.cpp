// The engine of integrals: passes, budgets, states.
#include "lab/integral/integrate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "statistics.h"

namespace montelux::lab {
namespace {

using namespace montelux::test;

Problem cubic() {
  return {.integrand = {1, pointwise([](const double* x) { return 4 * x[0] * x[0] * x[0]; })}};
}
Method method_named(std::string_view text) { return parse_method(text).value(); }

TEST(Integrate, uniform_points_find_the_integral_of_4x3) {
  const IntegralResult r = integrate(cubic(), method_named("uniform"), {.samples = 100000});
  EXPECT_LT(std::abs(r.mean - 1), 5 * r.standard_error);
  // The variance of 4x^3 is 16/7 - 1, and its fourth central moment 256/13 - 4 64/10 + 6 16/7 - 3 gives the spread of
  // an estimate of it from n samples: the root of (moment - variance^2) / n.
  const double variance = 9.0 / 7.0, moment = 256.0 / 13 - 25.6 + 96.0 / 7 - 3;
  const double spread = std::sqrt((moment - variance * variance) / 100000);
  EXPECT_LT(std::abs(r.variance_of_one_sample - variance), 4 * spread);
  EXPECT_GT(std::abs(r.variance_of_one_sample - 1.04 * variance), 4 * spread);
  // About four standard deviations of a standard error over the 32 passes.
  EXPECT_NEAR(r.standard_error, std::sqrt(9.0 / 7.0 / 100000), 0.5 * std::sqrt(9.0 / 7.0 / 100000));
  EXPECT_GE(r.evaluations, 99000u);
}

TEST(Integrate, the_bits_are_the_same_for_any_number_of_threads) {
  const IntegralResult one =
      integrate(cubic(), method_named("uniform"), {.samples = 1u << 20}, {.seed = 3, .threads = 1});
  const IntegralResult many =
      integrate(cubic(), method_named("uniform"), {.samples = 1u << 20}, {.seed = 3, .threads = 5});
  EXPECT_EQ(one.mean, many.mean);
  EXPECT_EQ(one.standard_error, many.standard_error);
  EXPECT_EQ(one.variance_of_one_sample, many.variance_of_one_sample);
}

TEST(Integrate, a_saved_state_continues_where_it_was) {
  const Method method = method_named("uniform");
  const IntegralResult half = integrate(cubic(), method, {.samples = 40000});
  const IntegralState loaded = state_from_json(to_json(half.state));
  EXPECT_EQ(result_of(loaded).mean, half.mean);
  const IntegralResult more = integrate(cubic(), method, {.samples = 40000}, {.resume = loaded});
  EXPECT_EQ(more.passes, 2 * half.passes);
  EXPECT_EQ(more.evaluations, 2 * half.evaluations);
}

TEST(Integrate, merged_states_are_one_run_and_equal_seeds_are_refused) {
  const Method method = method_named("uniform");
  const IntegralResult a = integrate(cubic(), method, {.samples = 40000}, {.seed = 1});
  const IntegralResult b = integrate(cubic(), method, {.samples = 40000}, {.seed = 2});
  const IntegralResult both = result_of(merge({a.state, b.state}));
  EXPECT_NEAR(both.mean, 0.5 * (a.mean + b.mean), 1e-14);
  EXPECT_EQ(both.evaluations, a.evaluations + b.evaluations);
  EXPECT_THROW(merge({a.state, a.state}), std::invalid_argument);
}

// A peak at 0.3 in the plane, with a control variate, densities and all.
Problem peak() {
  Problem p{.integrand = {2, pointwise([](const double* x) {
                            return std::exp(-20 * ((x[0] - 0.3) * (x[0] - 0.3) + (x[1] - 0.3) * (x[1] - 0.3)));
                          })}};
  p.control = ControlVariate{pointwise([](const double* x) { return x[0] + x[1]; }), 1.0};
  p.densities.push_back({.density = pointwise([](const double* x) { return 4 * (1 - x[0]) * (1 - x[1]); })});
  p.densities.push_back(
      {.density = pointwise([](const double*) { return 1.0; }), .sampling = DensitySampling::rejection});
  return p;
}
double peak_integral() {
  const double side =
      std::sqrt(std::numbers::pi / 20) / 2 * (std::erf(0.7 * std::sqrt(20)) + std::erf(0.3 * std::sqrt(20)));
  return side * side;
}
constexpr std::array<const char*, 12> one_of_each{"uniform",    "stratified", "antithetic",     "control",
                                                  "importance", "mis",        "qmc:adapt=true", "vegas",
                                                  "miser",      "ris",        "metropolis",     "auto"};

TEST(Integrate, every_method_gives_the_same_bits_for_any_number_of_threads) {
  for (const char* text : one_of_each) {
    const Budget budget{.samples = 1u << 17};
    const IntegralResult one = integrate(peak(), method_named(text), budget, {.seed = 3, .threads = 1});
    const IntegralResult many = integrate(peak(), method_named(text), budget, {.seed = 3, .threads = 4});
    EXPECT_EQ(one.mean, many.mean) << text;
    EXPECT_EQ(one.standard_error, many.standard_error) << text;
    EXPECT_EQ(one.why, many.why) << text;
    EXPECT_LT(std::abs(one.mean - peak_integral()), 6 * one.standard_error) << text;
  }
}

TEST(Integrate, auto_says_that_a_constant_has_nothing_to_adapt_to) {
  Problem constant;
  constant.integrand = {.dimension = 2,
                        .evaluate = [](PointBatch, std::span<double> out) { std::fill(out.begin(), out.end(), 3.0); }};
  const IntegralResult r = integrate(constant, method_named("auto"), {.samples = 1u << 16});
  EXPECT_NE(r.why.find("nothing to adapt to"), std::string::npos) << r.why;
  EXPECT_NEAR(r.mean, 3.0, 1e-14);
}

TEST(Integrate, every_method_continues_from_its_saved_state_as_if_it_had_not_stopped) {
  for (const char* text : one_of_each) {
    const IntegralResult first = integrate(peak(), method_named(text), {.samples = 1u << 14});
    const IntegralState loaded = state_from_json(to_json(first.state));
    EXPECT_EQ(to_json(loaded), to_json(first.state)) << text;
    const IntegralResult more = integrate(peak(), method_named("auto"), {.samples = 1u << 14}, {.resume = loaded});
    EXPECT_EQ(to_text(more.method), to_text(first.method)) << text;
    EXPECT_GT(more.passes, first.passes) << text;
    // The passes that were there are there still, and the new ones are of the same construction.
    for (std::size_t i = 0; i < first.state.passes.size(); ++i)
      EXPECT_EQ(more.state.passes[i].sum, first.state.passes[i].sum) << text;
    EXPECT_LT(std::abs(more.mean - peak_integral()), 6 * more.standard_error) << text;
  }
}

TEST(Integrate, the_fitted_coefficient_of_a_control_variate_is_the_best_one) {
  // f = x + x^2 with control x: the best coefficient is cov(f, x) / var(x) = (1/12 + 1/12) / (1/12) = 2.
  Problem p{.integrand = {1, pointwise([](const double* x) { return x[0] + x[0] * x[0]; })}};
  p.control = ControlVariate{pointwise([](const double* x) { return x[0]; }), 0.5};
  const IntegralResult fitted = integrate(p, method_named("control"), {.samples = 1u << 16});
  const IntegralResult given = integrate(p, method_named("control:coefficient=1"), {.samples = 1u << 16});
  // Of a fit of f by x to n points: the residual has the variance 1/180, and x 1/12.
  const double spread = std::sqrt(12.0 / 180 / (1u << 16));
  EXPECT_NEAR(*fitted.coefficient, 2, 5 * spread);
  EXPECT_EQ(*given.coefficient, 1);
  EXPECT_LT(fitted.standard_error, given.standard_error);
  EXPECT_LT(std::abs(fitted.mean - 5.0 / 6), 5 * fitted.standard_error);
  EXPECT_LT(std::abs(given.mean - 5.0 / 6), 5 * given.standard_error);
}

bool warns(const IntegralResult& r, IntegralWarning::Kind kind) {
  return std::any_of(r.warnings.begin(), r.warnings.end(), [&](const IntegralWarning& w) { return w.kind == kind; });
}

TEST(Diagnosis, values_that_are_not_finite_are_counted_and_reported) {
  const Problem p{.integrand = {1, pointwise([](const double* x) { return x[0] < 0.01 ? NAN : 1.0; })}};
  for (const char* text : {"uniform", "qmc", "miser", "vegas", "metropolis", "auto"}) {
    const IntegralResult r = integrate(p, method_named(text), {.samples = 10000});
    EXPECT_GT(r.non_finite, 0u) << text;
    EXPECT_TRUE(std::isfinite(r.mean)) << text;
    EXPECT_TRUE(warns(r, IntegralWarning::Kind::non_finite)) << text;
  }
}

TEST(Diagnosis, a_heavy_tail_is_found_and_a_light_one_is_not) {
  // x^-0.8 has no variance: the tail index of its values is 1.25. x^-0.2 has the tail index 5.
  const auto power = [](double exponent) {
    return Problem{.integrand = {1, pointwise([exponent](const double* x) { return std::pow(x[0], exponent); })}};
  };
  int heavy = 0, light = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const IntegralResult h = integrate(power(-0.8), method_named("uniform"), {.samples = 1u << 16}, {.seed = seed});
    const IntegralResult l = integrate(power(-0.2), method_named("uniform"), {.samples = 1u << 16}, {.seed = seed});
    EXPECT_NEAR(h.tail.hill_index, 1.25, 0.5);
    heavy += warns(h, IntegralWarning::Kind::heavy_tail), light += warns(l, IntegralWarning::Kind::heavy_tail);
  }
  EXPECT_EQ(heavy, 20);
  EXPECT_EQ(light, 0);
}

TEST(Diagnosis, a_density_that_is_zero_where_the_integrand_is_not_is_reported_with_its_bias) {
  // The density knows only the lower half of [0, 1]; the integral of 2x over the upper half is 3/4.
  Problem p{.integrand = {1, pointwise([](const double* x) { return 2 * x[0]; })}};
  p.densities.push_back({.density = pointwise([](const double* x) { return x[0] < 0.5 ? 2.0 : 0.0; })});
  const IntegralResult r = integrate(p, method_named("importance"), {.samples = 1u << 16});
  EXPECT_LT(std::abs(r.mean - 0.25), 5 * r.standard_error);
  EXPECT_LT(r.standard_error, 1e-3);
  ASSERT_TRUE(warns(r, IntegralWarning::Kind::missed_region));
  const DensityReport report = inspect_density(p, 0);
  EXPECT_NEAR(report.missed, 0.75, 5 * report.missed_error);
  EXPECT_TRUE(report.normalised());
  // With a second density that reaches everywhere nothing is missed.
  p.densities.push_back({.density = pointwise([](const double*) { return 1.0; })});
  const IntegralResult both = integrate(p, method_named("mis"), {.samples = 1u << 16});
  EXPECT_FALSE(warns(both, IntegralWarning::Kind::missed_region));
  EXPECT_LT(std::abs(both.mean - 1), 5 * both.standard_error);
}

TEST(Diagnosis, densities_are_held_to_their_integral_and_sign) {
  const auto report_of = [](auto density) {
    Problem p{.integrand = {1, pointwise([](const double*) { return 1.0; })}};
    p.densities.push_back({.density = pointwise(density)});
    return inspect_density(p, 0);
  };
  EXPECT_TRUE(report_of([](const double* x) { return 2 * x[0]; }).normalised());
  EXPECT_FALSE(report_of([](const double* x) { return 2.01 * x[0]; }).normalised());
  EXPECT_NEAR(report_of([](const double* x) { return 3 * x[0]; }).integral, 1.5, 1e-4);
  EXPECT_TRUE(report_of([](const double* x) { return 4 * x[0] - 1; }).negative);
  EXPECT_FALSE(report_of([](const double* x) { return 2 * x[0]; }).negative);
}

// Each of the accepted points took a geometric number of tries: is the probability of a success `truth`?
double acceptance_p_value(const IntegralResult& r, double truth) {
  const double n = double(r.state.accepted);
  EXPECT_EQ(*r.acceptance, n / double(r.state.proposed));
  return z_test(double(r.state.proposed), std::sqrt(n * (1 - truth)) / truth, n / truth).p_value;
}

TEST(Diagnosis, rejection_reports_its_acceptance_and_refuses_a_bound_that_is_too_small) {
  Problem p{.integrand = {1, pointwise([](const double* x) { return x[0] * x[0]; })}};
  p.densities.push_back({.density = pointwise([](const double* x) { return 2 * x[0]; }),
                         .sampling = DensitySampling::rejection,
                         .bound = 4.0});
  const IntegralResult r = integrate(p, method_named("importance"), {.samples = 1u << 14});
  EXPECT_GT(acceptance_p_value(r, 0.25), family_level);
  EXPECT_LT(acceptance_p_value(r, 1.05 * 0.25), family_level);
  EXPECT_LT(std::abs(r.mean - 1.0 / 3), 5 * r.standard_error);
  p.densities.front().bound = 1.0;
  EXPECT_THROW(integrate(p, method_named("importance"), {.samples = 1u << 14}), std::invalid_argument);
}

TEST(Diagnosis, the_bound_of_rejection_is_found_in_a_far_corner) {
  // The product of 2 x_d over 8 axes has its maximum 2^8 in one corner of 2^8.
  Problem p{.integrand = {8, pointwise([](const double* x) { return x[0] + x[7]; })}};
  p.densities.push_back({.density = pointwise([](const double* x) {
                           double product = 1;
                           for (int d = 0; d < 8; ++d) product *= 2 * x[d];
                           return product;
                         })});
  const IntegralResult r = integrate(p, method_named("importance"), {.samples = 1u << 14});
  // The bound is the maximum that was found and a fifth more.
  EXPECT_GT(acceptance_p_value(r, 1 / (1.2 * 256)), family_level);
  EXPECT_LT(acceptance_p_value(r, 1.05 / (1.2 * 256)), family_level);
}

TEST(Budget, a_target_stops_the_run_and_a_budget_that_ends_first_is_said) {
  const IntegralResult reached = integrate(peak(), method_named("qmc"), {.target_error = 1e-3});
  EXPECT_TRUE(reached.target_reached);
  EXPECT_EQ(reached.stopped_because, StopReason::target_error);
  EXPECT_LE(reached.interval.high - reached.interval.low, 2e-3);
  EXPECT_LT(std::abs(reached.mean - peak_integral()), 1e-3);
  const IntegralResult ended = integrate(peak(), method_named("uniform"), {.samples = 10000, .target_error = 1e-6});
  EXPECT_FALSE(ended.target_reached);
  EXPECT_EQ(ended.stopped_because, StopReason::samples);
  EXPECT_TRUE(warns(ended, IntegralWarning::Kind::target));
  EXPECT_LE(ended.evaluations, 10000u);
}

TEST(Budget, a_run_stops_at_its_time_and_when_it_is_requested) {
  const IntegralResult timed = integrate(peak(), method_named("auto"), {.seconds = 0.05});
  EXPECT_EQ(timed.stopped_because, StopReason::seconds);
  EXPECT_GT(timed.evaluations, 10000u);
  int requested = 0;
  const IntegralResult stopped = integrate(peak(), method_named("uniform"), {.samples = std::uint64_t(1) << 40},
                                           {.stop = [&] { return ++requested > 300; }});
  EXPECT_EQ(stopped.stopped_because, StopReason::stopped);
}

TEST(Methods, what_a_method_lacks_is_reported) {
  const Problem bare{.integrand = {1, pointwise([](const double* x) { return x[0]; })}};
  for (const char* text : {"control", "importance", "mis"})
    EXPECT_THROW(integrate(bare, method_named(text), {.samples = 100}), std::invalid_argument) << text;
  EXPECT_THROW(integrate({.integrand = {65, bare.integrand.evaluate}}, {}, {.samples = 100}), std::invalid_argument);
  EXPECT_THROW(integrate(bare, {}, {.target_error = -1.0}), std::invalid_argument);
}

TEST(Methods, every_name_is_read_and_written_back) {
  for (const EntitySpec& entity : method_table()) EXPECT_EQ(to_text(method_named(entity.name)), entity.name);
  EXPECT_EQ(to_text(method_named("qmc:baker=true,points=lattice")), "qmc:points=lattice,baker=on");
  EXPECT_EQ(to_text(method_named("mis:heuristic=max")), "mis:heuristic=maximum");
  // A default that is stated is the same number, to the last bit.
  EXPECT_EQ(method_named("metropolis:step=0.3").step, method_named("metropolis").step);
}

TEST(Methods, wrong_names_and_values_are_reported) {
  for (const char* text : {"unifrom", "qmc(points=sobl)", "qmc(baker=maybe)", "ris(candidates=0)",
                           "vegas(points=sobol)", "qmc(points=sobol"}) {
    EXPECT_FALSE(parse_method(text)) << text;
  }
}

}  // namespace
}  // namespace montelux::lab
