// Domains: their measures in closed form, the points of their maps, and mistakes in their texts.
#include "lab/domain/domain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace montelux::lab {
namespace {

using std::numbers::pi;

std::shared_ptr<const Domain> domain_of(const std::vector<std::string>& texts) {
  ParsedDomain parsed = parse_domain(texts);
  for (const DomainMistake& m : parsed.mistakes) ADD_FAILURE() << explain(m.text, m.mistake);
  return parsed.domain ? std::make_shared<const Domain>(*parsed.domain) : nullptr;
}

// The integral by the midpoint rule with n points a dimension.
double midpoint(const std::vector<std::string>& over, std::string_view text, std::size_t n) {
  const auto domain = domain_of(over);
  if (!domain) return NAN;
  const CompiledExpression e = compile(text, domain->variables());
  if (!e.expression) return NAN;
  const BatchFunction f = on_cube(domain, *e.expression);
  const std::size_t dimension = domain->dimension();
  std::size_t count = 1;
  for (std::size_t d = 0; d < dimension; ++d) count *= n;
  std::vector<double> points(count * dimension), values(count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t d = 0, rest = i; d < dimension; ++d, rest /= n)
      points[d * count + i] = (double(rest % n) + 0.5) / double(n);
  f({points, dimension, count}, values);
  double sum = 0;
  for (double v : values) sum += v;
  return sum / double(count);
}

TEST(Domain, measures_are_those_of_geometry) {
  const std::vector<std::pair<std::string, double>> cases{{"x=-1:3", 4},
                                                          {"x=0:1,y=0:2", 2},
                                                          {"disk", pi},
                                                          {"disk:radius=2", 4 * pi},
                                                          {"triangle", 0.5},
                                                          {"triangle:a=(0,0,1),b=(2,0,1),c=(0,3,1)", 3},
                                                          {"sphere", 4 * pi},
                                                          {"hemisphere", 2 * pi},
                                                          {"ball", 4 * pi / 3},
                                                          {"hemisphere:measure=projected", pi},
                                                          {"simplex", 0.5},
                                                          {"simplex:dimension=4", 1.0 / 24},
                                                          {"cube:dimension=5", 1},
                                                          {"x=0:pi/2", pi / 2}};
  for (const auto& [text, measure] : cases) {
    const auto domain = domain_of({text});
    ASSERT_TRUE(domain);
    ASSERT_TRUE(domain->volume()) << text;
    EXPECT_NEAR(*domain->volume(), measure, 1e-14 * measure) << text;
    EXPECT_NEAR(midpoint({text}, "1", 3), measure, 1e-12 * measure) << text;
  }
}

// The midpoint rule of n cells a side misses by a multiple of 1 / n^2, or, where a root has its end in the domain, of
// n^-1.5; where the chart makes the integrand linear, by rounding.
TEST(Domain, integrals_have_their_closed_forms) {
  EXPECT_NEAR(midpoint({"x=0:1"}, "4*x^3", 1000), 1, 1e-6);
  EXPECT_NEAR(midpoint({"x=0:1,y=0:x"}, "y", 400), 1.0 / 6, 5e-7);
  EXPECT_NEAR(midpoint({"disk:radius=2"}, "x^2", 400), 4 * pi, 1e-11);
  EXPECT_NEAR(midpoint({"disk"}, "r*cos(phi)^2", 400), pi / 3, 3e-5);
  EXPECT_NEAR(midpoint({"sphere"}, "z^2", 400), 4 * pi / 3, 5e-5);
  EXPECT_NEAR(midpoint({"sphere"}, "cos(theta)^2 + x*y", 400), 4 * pi / 3, 5e-5);
  EXPECT_NEAR(midpoint({"hemisphere"}, "z", 400), pi, 1e-11);
  EXPECT_NEAR(midpoint({"hemisphere"}, "x^2", 400), 2 * pi / 3, 5e-6);
  EXPECT_NEAR(midpoint({"hemisphere:measure=projected"}, "z", 400), 2 * pi / 3, 5e-5);
  EXPECT_NEAR(midpoint({"ball"}, "x^2+y^2+z^2", 60), 4 * pi / 5, 5e-4);
  EXPECT_NEAR(midpoint({"ball"}, "z^2", 60), 4 * pi / 15, 3e-4);
  EXPECT_NEAR(midpoint({"triangle:a=(0,0),b=(1,0),c=(1,1)"}, "x*y", 400), 1.0 / 8, 5e-6);
  EXPECT_NEAR(midpoint({"simplex:dimension=3"}, "x + 2*y - z", 60), 1.0 / 12, 1e-4);
  EXPECT_NEAR(midpoint({"simplex:dimension=4"}, "x4", 20), 1.0 / 120, 1e-4);
  EXPECT_NEAR(midpoint({"disk", "t=0:2"}, "t*(x^2+y^2)", 60), pi, 1e-11);
  EXPECT_NEAR(midpoint({"disk", "t=0:r"}, "1", 60), 2 * pi / 3, 1e-3);
}

TEST(Domain, infinite_bounds_are_reached) {
  EXPECT_NEAR(midpoint({"x=-inf:inf"}, "exp(-x^2)", 2000), std::sqrt(pi), 1e-6);
  EXPECT_NEAR(midpoint({"x=0:inf"}, "exp(-x)", 20000), 1, 1e-6);
  EXPECT_NEAR(midpoint({"x=-inf:2"}, "exp(x)", 20000), std::exp(2), 1e-5);
  EXPECT_NEAR(midpoint({"x=1:inf"}, "1/x^2", 1000), 1, 1e-6);
  EXPECT_NEAR(midpoint({"x=-inf:inf,y=x:inf"}, "exp(-x^2-y^2)", 400), pi / 2, 2e-6);
}

TEST(Domain, the_ends_of_the_cube_give_finite_points) {
  for (const char* text : {"x=-inf:inf", "x=0:inf", "x=-inf:0"}) {
    const auto domain = domain_of({text});
    const BatchFunction f = on_cube(domain, *compile("exp(-abs(x))", domain->variables()).expression);
    const std::vector<double> u{0.0, 1 - 0x1p-53};
    std::vector<double> values(2);
    f({u, 1, 2}, values);
    EXPECT_TRUE(std::isfinite(values[0]) && std::isfinite(values[1])) << text;
  }
}

TEST(Domain, points_go_back_to_the_cube) {
  const auto domain = domain_of({"x=-2:3,y=x:4,s=-inf:inf,t=0:inf,v=-inf:1"});
  const std::size_t n = 50;
  std::vector<double> u(5 * n), back(5 * n);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::fmod(0.5 + 0.618033988749895 * double(i), 1.0);
  const std::vector<char> all(5, 1);
  const DomainPoints p = domain->map({u, 5, n}, all);
  domain->invert(p.columns, n, back);
  for (std::size_t i = 0; i < u.size(); ++i) EXPECT_NEAR(back[i], u[i], 1e-12) << i;
}

TEST(Domain, a_mistake_is_reported_with_its_place) {
  struct Case {
    std::string text;
    std::size_t position, length;
    std::string words;
  };
  for (const Case& c : std::vector<Case>{{"dsk", 0, 3, "did you mean \"disk\""},
                                         {"x", 0, 1, "x=0:1"},
                                         {"x=0", 2, 1, "low:high"},
                                         {"x=0:1,y", 6, 1, "name=low:high"},
                                         {"x=0:1,x=0:2", 6, 1, "two variables"},
                                         {"x=1:0", 2, 3, "not below"},
                                         {"x=0:y,y=0:1", 4, 1, "unknown name \"y\""},
                                         {"x=0:p", 4, 1, "did you mean"},
                                         {"x=0:1/0-1/0", 4, 7, "upper bound"},
                                         {"sin=0:1", 0, 3, "cannot be a variable"},
                                         {"disk:radius=-1", 12, 2, "above 0"},
                                         {"disk:radios=1", 5, 6, "did you mean \"radius\""},
                                         {"disk:radius=1+", 14, 1, "too early"},
                                         {"simplex:dimension=65", 18, 2, "from 1 to 64"},
                                         {"hemisphere:measure=cosine", 19, 6, "solid-angle, projected"},
                                         {"triangle:a=(0,0),b=(1,1),c=(2,2)", 0, 32, "collinear"},
                                         {"triangle:a=(0,0,0),b=(1,1)", 0, 26, "all three"},
                                         {"triangle:a=0", 11, 1, "(x, y)"}}) {
    const ParsedDomain parsed = parse_domain({c.text});
    ASSERT_FALSE(parsed.mistakes.empty()) << c.text;
    const TextMistake& m = parsed.mistakes[0].mistake;
    EXPECT_EQ(m.position, c.position) << c.text << ": " << m.message;
    EXPECT_EQ(m.length, c.length) << c.text << ": " << m.message;
    EXPECT_NE(m.message.find(c.words), std::string::npos) << c.text << ": " << m.message;
  }
}

TEST(Domain, all_mistakes_are_reported_together) {
  EXPECT_EQ(parse_domain({"x=0:w,y=2:1,z=0:1", "dsk", "disk:radius=0"}).mistakes.size(), 4u);
  EXPECT_EQ(parse_domain({"x=0:1", "disk"}).mistakes.size(), 1u);
  EXPECT_EQ(parse_domain({"cube:dimension=40", "t=0:1", "simplex:dimension=30"}).mistakes.size(), 1u);
}

}  // namespace
}  // namespace montelux::lab
