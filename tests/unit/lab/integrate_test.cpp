// The engine of integrals: passes, budgets, states.
#include "lab/integral/integrate.h"

#include <gtest/gtest.h>

namespace montelux::lab {
namespace {

Problem cubic() {
  return {.integrand = {1, pointwise([](const double* x) { return 4 * x[0] * x[0] * x[0]; })}};
}
Method method_named(std::string_view text) { return parse_method(text).value(); }

TEST(Integrate, uniform_points_find_the_integral_of_4x3) {
  const IntegralResult r = integrate(cubic(), method_named("uniform"), {.samples = 100000});
  EXPECT_LT(std::abs(r.mean - 1), 5 * r.standard_error);
  // The variance of 4x^3 is 16/7 - 1.
  EXPECT_NEAR(r.variance_of_one_sample, 9.0 / 7.0, 0.05);
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

TEST(Integrate, a_saved_state_goes_on_where_it_was) {
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

TEST(Methods, every_name_is_read_and_written_back) {
  for (const EntitySpec& entity : method_table()) EXPECT_EQ(to_text(method_named(entity.name)), entity.name);
  EXPECT_EQ(to_text(method_named("qmc:baker=true,points=lattice")), "qmc:points=lattice,baker=true");
  EXPECT_EQ(to_text(method_named("mis:heuristic=max")), "mis:heuristic=maximum");
}

TEST(Methods, wrong_names_and_values_are_told) {
  for (const char* text : {"unifrom", "qmc(points=sobl)", "qmc(baker=maybe)", "ris(candidates=0)",
                           "vegas(points=sobol)", "qmc(points=sobol"}) {
    EXPECT_FALSE(parse_method(text)) << text;
  }
}

}  // namespace
}  // namespace montelux::lab
