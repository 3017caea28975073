// Formulas as typed by a user, compiled once and evaluated for many points at a time: 4*x^3, exp(-x*y), x < 1 ? x : 0.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/expression/program.h"

namespace montelux::lab {

// What is wrong with a text, and where: `length` characters from `position`, both in bytes.
struct TextMistake {
  std::size_t position = 0, length = 1;
  std::string message;
};

// The message, and below it the text with a caret at the position; no line break at the end.
std::string explain(std::string_view text, const TextMistake& mistake);

// A compiled formula. Immutable, so it may be evaluated by several threads at once.
class Expression {
 public:
  Expression(std::string text, Program program) : text_(std::move(text)), program_(std::move(program)) {}
  const std::string& text() const { return text_; }
  // Whether the formula depends on the variable with that index.
  bool uses(std::size_t variable) const;
  bool constant() const;

  // Sets values[i] to the formula with variable k equal to columns[k][i]. Unused columns may be null.
  void evaluate(std::span<const double* const> columns, std::span<double> values) const;
  // At one point.
  double operator()(std::span<const double> variables) const;

 private:
  std::string text_;
  Program program_;
};

// An expression, or all errors in the text.
struct CompiledExpression {
  std::optional<Expression> expression;
  std::vector<TextMistake> mistakes;
};

// Names are case-sensitive; operators by rising precedence: ?:, ||, &&, comparisons, + -, * /, signs, ^ (to the right).
CompiledExpression compile(std::string_view text, const std::vector<std::string>& variables);

// Starts with a letter or an underscore, continues with these and digits, and is not a constant or a function.
bool valid_variable(std::string_view name);

}  // namespace montelux::lab
