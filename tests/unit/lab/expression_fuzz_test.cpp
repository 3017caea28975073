// Texts that nobody would type: they give an expression or mistakes with places inside of the text, and never a crash.
#include <gtest/gtest.h>

#include <cmath>

#include "lab/domain/domain.h"
#include "mc/random.h"

namespace montelux::lab {
namespace {

constexpr std::string_view pieces[] = {"x",    "y",   "sin", "pow", "min", "(",  ")", ",",  "+", "-",   "*", "/",
                                       "^",    "<",   "<=",  "==",  "!=",  "&&", "!", "?",  ":", "1",   " ", "0.5",
                                       "1e-3", "inf", "pi",  "=",   "|",   "²",  "e", "1e", ".", "foo", "#", "0x1F"};

std::string random_text(RandomStream<float>& stream) {
  std::string text;
  const int count = int(stream.next() * 12);
  for (int i = 0; i < count; ++i) text += pieces[std::size_t(stream.next() * float(std::size(pieces)))];
  return text;
}

TEST(ExpressionFuzz, every_text_is_an_expression_or_a_mistake_inside_of_it) {
  RandomStream<float> stream(0u, 11u);
  int good = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string text = random_text(stream);
    const CompiledExpression compiled = compile(text, {"x", "y"});
    EXPECT_NE(compiled.expression.has_value(), !compiled.mistakes.empty()) << text;
    for (const TextMistake& m : compiled.mistakes) {
      EXPECT_LE(m.position, text.size()) << text;
      EXPECT_FALSE(m.message.empty()) << text;
      EXPECT_FALSE(explain(text, m).empty());
    }
    if (!compiled.expression) continue;
    ++good;
    // One point and many have the same value.
    const std::vector<double> x(300, 0.25), y(300, -1.5);
    std::vector<double> values(300);
    const double* columns[] = {x.data(), y.data()};
    compiled.expression->evaluate(columns, values);
    const double point[] = {0.25, -1.5}, one = (*compiled.expression)(point);
    EXPECT_TRUE(values[299] == one || (std::isnan(one) && std::isnan(values[299]))) << text;
  }
  EXPECT_GT(good, 100);
}

TEST(ExpressionFuzz, every_text_is_a_domain_or_a_mistake_inside_of_it) {
  constexpr std::string_view words[] = {"disk", "triangle",   "simplex", "cube", "ball", "x=", "y=",  "0",
                                        "1",    ":",          ",",       "(",    ")",    "=",  "inf", "radius",
                                        "a=",   "dimension=", "-",       "x",    "pi",   " ",  "/",   "z"};
  RandomStream<float> stream(1u, 11u);
  int good = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    const int count = int(stream.next() * 8);
    for (int k = 0; k < count; ++k) text += words[std::size_t(stream.next() * float(std::size(words)))];
    const ParsedDomain parsed = parse_domain({text});
    EXPECT_NE(parsed.domain.has_value(), !parsed.mistakes.empty()) << text;
    for (const DomainMistake& m : parsed.mistakes) EXPECT_LE(m.mistake.position, text.size()) << text;
    good += parsed.domain.has_value();
  }
  EXPECT_GT(good, 20);
}

}  // namespace
}  // namespace montelux::lab
