#include "lab/expression/expression.h"

#include <algorithm>

namespace montelux::lab {
namespace {

// The number of characters, not bytes, of UTF-8 text.
std::size_t characters(std::string_view text) {
  return std::size_t(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

bool is_column(const Operand& o, std::size_t index) { return o.kind == Operand::Kind::column && o.index == index; }

// The part of a long text in which an error is shown: it begins and ends between characters of UTF-8.
struct Excerpt {
  std::size_t begin, end;
};
Excerpt excerpt_of(std::string_view text, std::size_t begin, std::size_t length) {
  constexpr std::size_t around = 60, longest = 160;
  const auto boundary = [&](std::size_t i) {
    while (i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0u) == 0x80u) ++i;
    return std::min(i, text.size());
  };
  if (text.size() <= longest) return {0, text.size()};
  const std::size_t from = begin > around ? boundary(begin - around) : 0;
  return {from, boundary(std::min(from + longest, begin + std::min(length, longest) + around))};
}

}  // namespace

std::string explain(std::string_view whole, const TextMistake& mistake) {
  std::size_t begin = std::min(mistake.position, whole.size());
  const auto [from, to] = excerpt_of(whole, begin, mistake.length);
  const std::string_view before = from > 0 ? "... " : "", after = to < whole.size() ? " ..." : "";
  const std::string_view text = whole.substr(from, to - from);
  begin -= from;
  const std::size_t length = std::max<std::size_t>(1, characters(text.substr(begin, mistake.length)));
  std::string line = std::string(before) + std::string(text) + std::string(after);
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\t' || c == '\r'; }, ' ');
  return mistake.message + "\n    " + line + "\n    " +
         std::string(before.size() + characters(text.substr(0, begin)), ' ') + "^" + std::string(length - 1, '~');
}

bool Expression::uses(std::size_t variable) const {
  if (is_column(program_.result, variable)) return true;
  for (const Instruction& i : program_.instructions)
    if (std::ranges::any_of(i.operands, [variable](const Operand& o) { return is_column(o, variable); })) return true;
  return false;
}

bool Expression::constant() const {
  const auto varies = [](const Operand& o) { return o.kind == Operand::Kind::column; };
  if (varies(program_.result)) return false;
  return std::ranges::none_of(program_.instructions,
                              [&](const Instruction& i) { return std::ranges::any_of(i.operands, varies); });
}

void Expression::evaluate(std::span<const double* const> columns, std::span<double> values) const {
  program_.run(columns, values);
}

double Expression::operator()(std::span<const double> variables) const {
  std::vector<const double*> columns;
  for (const double& value : variables) columns.push_back(&value);
  double result = 0;
  program_.run(columns, {&result, 1});
  return result;
}

}  // namespace montelux::lab
