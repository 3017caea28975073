#include "io/pbrt/lexer.h"

#include <array>

#include "io/text_file.h"

namespace montelux::pbrt {

namespace {

enum CharacterClass : unsigned char { inside, blank, delimiter };

// What ends a word or number.
constexpr std::array<CharacterClass, 256> character_classes = [] {
  std::array<CharacterClass, 256> classes{};
  for (char c : {' ', '\t', '\r', '\n', '\v', '\f'}) classes[static_cast<unsigned char>(c)] = blank;
  for (char c : {'"', '[', ']', '#'}) classes[static_cast<unsigned char>(c)] = delimiter;
  return classes;
}();

CharacterClass class_of(char c) { return character_classes[static_cast<unsigned char>(c)]; }

}  // namespace

void Lexer::skip_blank() {
  while (at_ < text_.size()) {
    char c = text_[at_];
    if (c == '\n') {
      ++line_, line_start_ = ++at_;
    } else if (class_of(c) == blank) {
      ++at_;
    } else if (c == '#') {
      std::size_t end = text_.find('\n', at_);
      at_ = end == std::string_view::npos ? text_.size() : end;
    } else {
      return;
    }
  }
}

Token Lexer::scan() {
  skip_blank();
  Token token;
  token.line = line_;
  token.column = static_cast<int>(at_ - line_start_) + 1;
  if (at_ >= text_.size()) return token;
  char first = text_[at_];
  if (first == '"') return scan_quoted(token);
  std::size_t start = at_++;
  if (first == '[' || first == ']') {
    token.kind = first == '[' ? TokenKind::open : TokenKind::close;
  } else {
    while (at_ < text_.size() && class_of(text_[at_]) == inside) ++at_;
    bool numeric = (first >= '0' && first <= '9') || first == '-' || first == '+' || first == '.';
    token.kind = numeric ? TokenKind::number : TokenKind::word;
  }
  token.text = text_.substr(start, at_ - start);
  return token;
}

// A string ends on its line.
Token Lexer::scan_quoted(Token token) {
  std::size_t start = ++at_;
  while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n') at_ += text_[at_] == '\\' ? 2 : 1;
  at_ = std::min(at_, text_.size());
  token.text = text_.substr(start, at_ - start);
  bool closed = at_ < text_.size() && text_[at_] == '"';
  token.kind = closed ? TokenKind::quoted : TokenKind::unclosed_quote;
  // An escaped line feed inside an unclosed string still counts as a line.
  for (std::size_t i = start; i < at_; ++i)
    if (text_[i] == '\n') ++line_, line_start_ = i + 1;
  if (closed) ++at_;
  return token;
}

std::string unescape(std::string_view quoted) {
  std::string plain;
  plain.reserve(quoted.size());
  for (std::size_t i = 0; i < quoted.size(); ++i) {
    if (quoted[i] != '\\' || i + 1 == quoted.size()) {
      plain += quoted[i];
      continue;
    }
    char c = quoted[++i];
    plain += c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c == 'b' ? '\b' : c == 'f' ? '\f' : c;
  }
  return plain;
}

std::string describe(const Token& token) {
  if (token.kind == TokenKind::end) return "the end of the file";
  if (token.kind == TokenKind::quoted) return "\"" + printable(token.text) + "\"";
  return "'" + printable(token.text) + "'";
}

}  // namespace montelux::pbrt
