// The words of a pbrt file.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "parameter/diagnostic.h"

namespace montelux::pbrt {

enum class TokenKind { end, word, number, quoted, open, close, unclosed_quote };

// `text` points into the file's text; that of a quoted string is without its quotes and with its escapes as written.
struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;
  int line = 0;
  int column = 0;
};

// Cuts text into tokens; white space and comments (# to the end of the line) part them. The text must outlive it.
class Lexer {
 public:
  Lexer(std::string_view text, std::shared_ptr<const std::string> file) : text_(text), file_(std::move(file)) {}

  // The token ahead; next() steps over it.
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

// The string that a quoted token means: \n, \t, \r, \b, \f, \\, \' and \" resolved.
std::string unescape(std::string_view quoted);

// How a message names a token: 'text', or "the end of the file".
std::string describe(const Token& token);

}  // namespace montelux::pbrt
