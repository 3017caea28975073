// Expressions: what they evaluate to, and how mistakes in them are reported.
#include "lab/expression/expression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace montelux::lab {
namespace {

const std::vector<std::string> xyz{"x", "y", "z"};

double value(std::string_view text, double x = 0, double y = 0, double z = 0) {
  const CompiledExpression compiled = compile(text, xyz);
  EXPECT_TRUE(compiled.expression) << text << ": " << (compiled.mistakes.empty() ? "" : compiled.mistakes[0].message);
  const double variables[] = {x, y, z};
  return compiled.expression ? (*compiled.expression)(variables) : NAN;
}

// The mistakes of a text, each as its first line and the place of the caret.
std::vector<TextMistake> mistakes(std::string_view text) { return compile(text, xyz).mistakes; }

TEST(Expression, operators_bind_as_in_mathematics) {
  EXPECT_EQ(value("4*x^3", 0.5), 0.5);
  EXPECT_EQ(value("-x^2", 3), -9);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("x^-2", 2), 0.25);
  EXPECT_EQ(value("1 - 2 - 3"), -4);
  EXPECT_EQ(value("8/4/2"), 1);
  EXPECT_EQ(value("2+3*4"), 14);
  EXPECT_EQ(value("(2+3)*4"), 20);
  EXPECT_EQ(value("x < y && y < z", 1, 2, 3), 1);
  EXPECT_EQ(value("x > y || !(y < z)", 1, 2, 3), 0);
  EXPECT_EQ(value("x != y", 1, 2), 1);
  EXPECT_EQ(value("1e-3 + .5"), 0.501);
}

TEST(Expression, a_choice_takes_one_side_even_where_the_other_is_not_finite) {
  EXPECT_EQ(value("x < 1 ? x : y", 0.5, 7), 0.5);
  EXPECT_EQ(value("x < 1 ? x : y", 1.5, 7), 7);
  EXPECT_EQ(value("x > 0 ? 1/x : 3", 0), 3);
  EXPECT_EQ(value("x < 1 ? 1 : x < 2 ? 2 : 3", 1.5), 2);
  EXPECT_EQ(value("(x < 1 ? 2 : 3) * (y < 1 ? 5 : 7)", 0, 2), 14);
}

TEST(Expression, functions_and_constants_have_their_usual_values) {
  EXPECT_EQ(value("pi"), std::numbers::pi);
  EXPECT_EQ(value("log(e)"), 1);
  EXPECT_EQ(value("sin(x)", 0.3), std::sin(0.3));
  EXPECT_EQ(value("erf(x)", 0.3), std::erf(0.3));
  EXPECT_EQ(value("gamma(5)"), 24);
  EXPECT_NEAR(value("lgamma(x)", 5), std::log(24), 1e-14);
  EXPECT_EQ(value("atan2(y, x)", -1, 0), std::numbers::pi);
  EXPECT_EQ(value("min(x, y, z)", 3, 1, 2), 1);
  EXPECT_EQ(value("max(x, y, z)", 3, 1, 2), 3);
  EXPECT_EQ(value("avg(x, y, z)", 3, 1, 2), 2);
  EXPECT_EQ(value("sum(x, 1)", 3), 4);
  EXPECT_EQ(value("clamp(x, 0, 1)", 3), 1);
  EXPECT_EQ(value("step(2, x)", 3), 1);
  EXPECT_EQ(value("heaviside(x)", -3), 0);
  EXPECT_EQ(value("mod(x, 3)", -1), 2);
  EXPECT_EQ(value("sign(x) * abs(x)", -3), -3);
  EXPECT_TRUE(std::isnan(value("max(1, sqrt(x))", -1)));
  EXPECT_TRUE(std::isinf(value("inf")));
  EXPECT_NEAR(value("pow(x, 2.5)", 2), std::pow(2, 2.5), 1e-15);
  for (const NamedFunction& f : expression_functions()) {
    const int n = std::max(1, f.arguments);
    std::string call = std::string(f.name) + "(";
    for (int k = 0; k < n; ++k) call += k == 0 ? "x" : k == 1 ? ",y" : ",z";
    const double batch = value(call + ")", 0.25, 0.5, 0.75);
    const double a[] = {0.25, 0.5, 0.75};
    const double one = f.one     ? f.one(a[0])
                       : f.two   ? f.two(a[0], a[1])
                       : f.three ? f.three(a[0], a[1], a[2])
                                 : f.any(a, 1);
    EXPECT_TRUE(batch == one || (std::isnan(batch) && std::isnan(one))) << f.name;
  }
}

TEST(Expression, many_points_have_the_values_of_each) {
  const CompiledExpression compiled =
      compile("exp(-x*y) + (x > y ? pow(x, 3) : max(y, 0.5, x)) - (x+1)^5/7 + 2*z", xyz);
  ASSERT_TRUE(compiled.expression);
  std::vector<double> x(1000), y(1000), z(1000), values(1000);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = 0.001 * double(i), y[i] = 0.7 - 0.0005 * double(i), z[i] = std::sin(double(i));
  const double* columns[] = {x.data(), y.data(), z.data()};
  compiled.expression->evaluate(columns, values);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = x[i], b = y[i];
    const double truth =
        std::exp(-a * b) + (a > b ? std::pow(a, 3) : std::max({b, 0.5, a})) - std::pow(a + 1, 5) / 7 + 2 * z[i];
    EXPECT_NEAR(values[i], truth, 1e-13) << i;
    const double point[] = {a, b, z[i]};
    EXPECT_EQ(values[i], (*compiled.expression)(point));
  }
}

TEST(Expression, it_knows_what_it_depends_on) {
  const Expression e = *compile("x^2 + sin(z)", xyz).expression;
  EXPECT_TRUE(e.uses(0));
  EXPECT_FALSE(e.uses(1));
  EXPECT_TRUE(e.uses(2));
  EXPECT_FALSE(e.constant());
  EXPECT_TRUE(compile("2*pi", xyz).expression->constant());
  EXPECT_TRUE(compile("y", xyz).expression->uses(1));
}

TEST(Expression, a_mistake_is_reported_with_its_place) {
  struct Case {
    std::string text;
    std::size_t position, length;
    std::string words;
  };
  for (const Case& c : std::vector<Case>{{"4*sinn(x)", 2, 4, "unknown function \"sinn\" (did you mean \"sin\"?)"},
                                         {"x + width", 4, 5, "the variables are x, y, z"},
                                         {"2x", 1, 1, "an operator is missing"},
                                         {"2(x+1)", 1, 1, "an operator is missing"},
                                         {"(x)(y)", 3, 1, "an operator is missing"},
                                         {"x y", 2, 1, "an operator is missing"},
                                         {"x**2", 1, 2, "^"},
                                         {"x=3", 1, 1, "=="},
                                         {"x & y", 2, 1, "&&"},
                                         {"sin x", 0, 3, "sin(...)"},
                                         {"x(3)", 0, 1, "x*(...)"},
                                         {"(x+1", 0, 1, "no closing bracket"},
                                         {"x+1)", 3, 1, "no opening bracket"},
                                         {"4*", 2, 1, "ends too early"},
                                         {"x + * y", 4, 1, "no left operand"},
                                         {"pow(x)", 5, 1, "pow takes 2 arguments"},
                                         {"sin(x, y)", 8, 1, "sin takes 1 argument"},
                                         {"x, y", 1, 1, "one value"},
                                         {"x ? 1", 2, 1, "other value"},
                                         {"x # 2", 2, 1, "\"#\" has no meaning"},
                                         {"x²", 1, 2, "has no meaning"},
                                         {"  ", 0, 1, "empty"}}) {
    const std::vector<TextMistake> found = mistakes(c.text);
    ASSERT_FALSE(found.empty()) << c.text;
    EXPECT_EQ(found[0].position, c.position) << c.text << ": " << found[0].message;
    EXPECT_EQ(found[0].length, c.length) << c.text << ": " << found[0].message;
    EXPECT_NE(found[0].message.find(c.words), std::string::npos) << c.text << ": " << found[0].message;
  }
}

TEST(Expression, all_unknown_names_are_reported_together) {
  const std::vector<TextMistake> found = mistakes("sinn(x) + cosh2(y) * (w");
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].position, 0u);
  EXPECT_EQ(found[1].position, 10u);
  EXPECT_EQ(found[2].position, 21u);
  EXPECT_EQ(found[3].position, 22u);
}

TEST(Expression, the_caret_stands_under_the_place) {
  EXPECT_EQ(explain("4*sinn(x)", {2, 4, "unknown"}), "unknown\n    4*sinn(x)\n      ^~~~");
  EXPECT_EQ(explain("é*w", {3, 1, "unknown"}), "unknown\n    é*w\n      ^");
}

}  // namespace
}  // namespace montelux::lab
