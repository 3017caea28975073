// Statements of integrals: what they become, and everything that is found wrong with them.
#include "lab/statement/statement.h"

#include <gtest/gtest.h>

#include "lab/statement/density_check.h"

namespace montelux::lab {
namespace {

std::vector<Method> methods(std::string_view text) { return {parse_method(text).value()}; }

// All mistakes in one text.
std::string mistakes(const IntegralStatement& statement, std::string_view method = "importance") {
  std::string all;
  for (const std::string& mistake : read_statement(statement, methods(method)).mistakes) all += mistake + "\n";
  return all;
}

IntegralStatement cubic(std::string density) {
  IntegralStatement s{.integrand = "4*x^3", .over = {"x=0:1"}};
  s.densities.push_back(std::move(density));
  return s;
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
}

TEST(Statement, a_good_density_is_taken_and_measured) {
  const StatementReading reading = read_statement(cubic("2*x, inverse=sqrt(u)"), methods("importance"));
  ASSERT_TRUE(reading.stated) << mistakes(cubic("2*x, inverse=sqrt(u)"));
  EXPECT_NEAR(reading.stated->densities[0].integral, 1, 1e-4);
  ASSERT_EQ(reading.stated->problem.densities.size(), 1u);
  const std::vector<double> u{0.25, 0.81};
  std::vector<double> x(2), p(2);
  (*reading.stated->problem.densities[0].inverse)({u, 1, 2}, x);
  EXPECT_NEAR(x[0], 0.5, 1e-15);
  EXPECT_NEAR(x[1], 0.9, 1e-15);
  reading.stated->problem.densities[0].density({u, 1, 2}, p);
  EXPECT_EQ(p[1], 1.62);
}

TEST(Statement, a_density_per_unit_of_a_stretched_domain_integrates_to_one) {
  IntegralStatement s{.integrand = "exp(-x^2)", .over = {"x=-inf:inf"}};
  s.densities = {"1/(pi*(1+x^2)), inverse=tan(pi*(u-0.5))", "exp(-x^2/2)/sqrt(2*pi)"};
  EXPECT_EQ(mistakes(s, "mis"), "");
  IntegralStatement plane{.integrand = "x*y", .over = {"x=0:2,y=0:x"}};
  plane.densities = {"x*y/2, inverse=(2*u1^0.25, 2*u1^0.25*sqrt(u2))"};
  EXPECT_EQ(mistakes(plane), "");
  IntegralStatement sphere{.integrand = "z", .over = {"hemisphere"}};
  sphere.densities = {"z/pi"};
  EXPECT_EQ(mistakes(sphere), "");
}

TEST(Statement, a_density_that_is_none_is_refused_with_a_measurement) {
  expect_words(mistakes(cubic("3*x")), {"integrates to 1.", "--normalize-pdf"});
  expect_words(mistakes(cubic("2.002*x")), {"integrates to 1.00"});
  expect_words(mistakes(cubic("3*x-0.5")), {"negative at x = 0."});
  expect_words(mistakes(cubic("0*x")), {"0 everywhere"});
  expect_words(mistakes(cubic("log(x-0.5)")), {"not finite at"});
  IntegralStatement scaled = cubic("3*x, inverse=sqrt(u)");
  scaled.normalize_densities = true;
  const StatementReading reading = read_statement(scaled, methods("importance"));
  ASSERT_TRUE(reading.stated);
  EXPECT_NEAR(*reading.stated->densities[0].scaled_by, 2.0 / 3, 1e-4);
}

TEST(Statement, an_inverse_of_another_density_is_refused) {
  EXPECT_EQ(mistakes(cubic("3*x^2, inverse=u^(1/3)")), "");
  expect_words(mistakes(cubic("2*x, inverse=u")), {"not distributed like"});
  expect_words(mistakes(cubic("2*x, inverse=u^0.48")), {"not distributed like"});
  expect_words(mistakes(cubic("2*x, inverse=1-sqrt(u)")), {"not distributed like"});
}

TEST(Statement, the_part_that_a_density_misses_is_measured) {
  // Half of the interval is never drawn; it holds 1/16 of the integral.
  const std::string text = "x < 0.5 ? 0 : 2, inverse=0.5+u/2";
  expect_words(mistakes(cubic(text)), {"0 where the integrand is not", "0.06", "--allow-missed"});
  IntegralStatement taken = cubic(text);
  taken.allow_missed = true;
  const StatementReading reading = read_statement(taken, methods("importance"));
  ASSERT_TRUE(reading.stated);
  ASSERT_EQ(reading.notes.size(), 1u);
  // Another density that covers the rest makes it right for mis.
  IntegralStatement both = cubic(text);
  both.densities.push_back("1 + 0*x");
  EXPECT_EQ(mistakes(both, "mis"), "");
  const MissedIntegral missed = missed_by(reading.stated->problem, reading.stated->problem.densities);
  EXPECT_LT(std::abs(missed.value - 1.0 / 16), 5 * missed.standard_error);
}

TEST(Statement, mistakes_of_all_parts_are_reported_together) {
  IntegralStatement s{.integrand = "4*sinn(x)", .over = {"x=0:1"}};
  s.densities = {"2*y", "2*x, inverze=sqrt(u)", "2*x, inverse=sqrt(v)", "2*x, sampling=tabel"};
  s.control = "x +", s.control_integral = "y";
  s.target = "x^";
  expect_words(mistakes(s),
               {"the integrand: unknown function \"sinn\"", "--pdf: unknown name \"y\"", "did you mean \"inverse\"",
                "unknown name \"v\"", "did you mean \"table\"", "--control: ", "--control-integral: ", "--target: "});
}

TEST(Statement, what_a_method_lacks_is_named) {
  IntegralStatement s{.integrand = "x", .over = {"x=0:1"}};
  expect_words(mistakes(s, "importance"), {"needs a density"});
  expect_words(mistakes(s, "mis"), {"needs a density"});
  expect_words(mistakes(s, "control"), {"--control-integral"});
  s.control = "x";
  expect_words(mistakes(s, "uniform"), {"needs its integral"});
  IntegralStatement disk{.integrand = "x", .over = {"disk"}};
  disk.densities = {"1/pi, inverse=(u1,u2)"};
  expect_words(mistakes(disk), {"domain of intervals"});
}

}  // namespace
}  // namespace montelux::lab
