#include "lab/expression/scan.h"

#include <fmt/format.h>

#include <algorithm>

#include "parameter/diagnostic.h"

namespace montelux::lab {
namespace {

// ASCII digits, for any locale.
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

enum class Kind { number, name, open, close, other };
struct Token {
  Kind kind;
  std::size_t begin, length;
};

std::size_t end_of_number(std::string_view text, std::size_t i) {
  while (i < text.size() && (is_digit(text[i]) || text[i] == '.')) ++i;
  if (i >= text.size() || (text[i] != 'e' && text[i] != 'E')) return i;
  std::size_t exponent = i + 1;
  if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
  if (exponent >= text.size() || !is_digit(text[exponent])) return i;
  while (exponent < text.size() && is_digit(text[exponent])) ++exponent;
  return exponent;
}

// The number of bytes of the character that starts here (UTF-8).
std::size_t character_length(std::string_view text, std::size_t i) {
  std::size_t end = i + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xc0u) == 0x80u) ++end;
  return end - i;
}

class Scanner {
 public:
  Scanner(std::string_view text, const std::vector<std::string>& variables) : text_(text), variables_(variables) {}

  std::vector<TextMistake> mistakes() {
    split();
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      if (tokens_[i].kind == Kind::name) check_name(i);
      if (i > 0) check_pair(tokens_[i - 1], tokens_[i]);
    }
    check_brackets();
    std::stable_sort(found_.begin(), found_.end(),
                     [](const TextMistake& a, const TextMistake& b) { return a.position < b.position; });
    return std::move(found_);
  }

 private:
  std::string_view word(const Token& t) const { return text_.substr(t.begin, t.length); }
  void complain(std::size_t position, std::size_t length, std::string message) {
    found_.push_back({position, length, std::move(message)});
  }

  void split() {
    for (std::size_t i = 0; i < text_.size();) {
      const char c = text_[i];
      std::size_t end = i + 1;
      if (is_digit(c) || (c == '.' && i + 1 < text_.size() && is_digit(text_[i + 1]))) {
        end = end_of_number(text_, i);
        tokens_.push_back({Kind::number, i, end - i});
      } else if (is_letter(c)) {
        while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
        tokens_.push_back({Kind::name, i, end - i});
      } else if (!is_space(c)) {
        end = i + symbol(i);
      }
      i = end;
    }
  }

  // Reads an operator or a bracket, and returns its length.
  std::size_t symbol(std::size_t i) {
    static constexpr std::string_view doubles[] = {"<=", ">=", "==", "!=", "&&", "||"};
    const std::string_view two = text_.substr(i, 2);
    std::size_t length = std::ranges::find(doubles, two) != std::end(doubles) ? 2 : 1;
    if (two == "**") {
      complain(i, 2, "powers are written with ^");
      length = 2;
    } else if (length == 1 && text_[i] == '=') {
      complain(i, 1, "assignment is not supported; equality is written ==");
    } else if (length == 1 && (text_[i] == '&' || text_[i] == '|')) {
      complain(i, 1, fmt::format("write {0}{0}", text_[i]));
    } else if (length == 1 && std::string_view("+-*/^()<>!?:,").find(text_[i]) == std::string_view::npos) {
      length = character_length(text_, i);
      complain(i, length, fmt::format("\"{}\" has no meaning here", text_.substr(i, length)));
    }
    tokens_.push_back({text_[i] == '(' ? Kind::open : text_[i] == ')' ? Kind::close : Kind::other, i, length});
    return length;
  }

  void check_name(std::size_t i) {
    const Token& t = tokens_[i];
    const bool called = i + 1 < tokens_.size() && tokens_[i + 1].kind == Kind::open;
    const bool variable = std::ranges::find(variables_, word(t)) != variables_.end();
    if (variable || find_constant(word(t))) {
      if (called)
        complain(t.begin, t.length, fmt::format("\"{0}\" is not a function; a product is written {0}*(...)", word(t)));
    } else if (find_function(word(t))) {
      if (!called) complain(t.begin, t.length, fmt::format("the function {0} is written {0}(...)", word(t)));
    } else {
      complain(t.begin, t.length, unknown(word(t), called));
    }
  }

  std::string unknown(std::string_view name, bool called) const {
    std::vector<std::string_view> near;
    if (!called) near.assign(variables_.begin(), variables_.end());
    for (const NamedFunction& f : expression_functions()) near.push_back(f.name);
    if (!called)
      for (const NamedConstant& c : expression_constants()) near.push_back(c.name);
    std::string message =
        fmt::format("unknown {} \"{}\"{}", called ? "function" : "name", name, did_you_mean(name, near));
    if (!called)
      message += variables_.empty() ? "; there are no variables here"
                                    : fmt::format("; the variables are {}", fmt::join(variables_, ", "));
    return message;
  }

  // Reports values without an operator between them.
  void check_pair(const Token& a, const Token& b) {
    const bool left = a.kind == Kind::number || a.kind == Kind::close || (a.kind == Kind::name && b.kind != Kind::open);
    const bool right = b.kind == Kind::number || b.kind == Kind::name || b.kind == Kind::open;
    if (!left || !right || (a.kind == Kind::name && find_function(word(a)))) return;
    complain(
        b.begin, b.length,
        fmt::format("an operator is missing between \"{}\" and \"{}\"; a product is written with *", word(a), word(b)));
  }

  void check_brackets() {
    std::vector<std::size_t> open;
    for (const Token& t : tokens_) {
      if (t.kind == Kind::open) open.push_back(t.begin);
      if (t.kind != Kind::close) continue;
      if (open.empty())
        complain(t.begin, 1, "this bracket has no opening bracket");
      else
        open.pop_back();
    }
    for (std::size_t position : open) complain(position, 1, "this bracket has no closing bracket");
  }

  std::string_view text_;
  const std::vector<std::string>& variables_;
  std::vector<Token> tokens_;
  std::vector<TextMistake> found_;
};

}  // namespace

const NamedFunction* find_function(std::string_view name) {
  const auto all = expression_functions();
  const auto it = std::ranges::find(all, name, &NamedFunction::name);
  return it == all.end() ? nullptr : &*it;
}

const NamedConstant* find_constant(std::string_view name) {
  const auto all = expression_constants();
  const auto it = std::ranges::find(all, name, &NamedConstant::name);
  return it == all.end() ? nullptr : &*it;
}

std::vector<TextMistake> scan_mistakes(std::string_view text, const std::vector<std::string>& variables) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return {{0, 1, "the expression is empty"}};
  return Scanner(text, variables).mistakes();
}

bool valid_variable(std::string_view name) {
  if (name.empty() || !is_letter(name[0]) || find_function(name) || find_constant(name)) return false;
  return std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace montelux::lab
