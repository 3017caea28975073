// The tokens of a pbrt file.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "parameter/diagnostic.h"

namespace montelux::pbrt {

enum class TokenKind { end, word, number, quoted, open, close, unclosed_quote };

// `text` points into the file's text; that of a quoted string excludes its quotes and keeps its escapes.
struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;
  int line = 0;
  int column = 0;
};

// Splits text into tokens, separated by white space and comments (# to the end of the line). The text must outlive it.
class Lexer {
 public:
  Lexer(std::string_view text, std::shared_ptr<const std::string> file) : text_(text), file_(std::move(file)) {}

  // The next token; next() consumes it.
  const Token& peek() {
    if (!has_ahead_) ahead_ = scan(), has_ahead_ = true;
    return ahead_;
  }
  Token next() {
    Token token = peek();
    has_ahead_ = false;
    return token;
  }
  SourceLocation where(const Token& token) const { return {file_, token.line, token.column}; }

 private:
  Token scan();
  Token scan_quoted(Token token);
  void skip_blank();

  std::string_view text_;
  std::shared_ptr<const std::string> file_;
  std::size_t at_ = 0, line_start_ = 0;
  int line_ = 1;
  Token ahead_;
  bool has_ahead_ = false;
};

// The value of a quoted token: \n, \t, \r, \b, \f, \\, \' and \" are resolved.
std::string unescape(std::string_view quoted);

// The name of a token in a message: 'text', or "the end of the file".
std::string describe(const Token& token);

}  // namespace montelux::pbrt
