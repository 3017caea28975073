#include "io/pbrt/parameters.h"

#include <array>
#include <bit>

#include "io/numbers.h"
#include "io/pbrt/spectra.h"
#include "io/text_file.h"

namespace montelux::pbrt {

namespace {

// The spelling of a type in a file; a spectrum has three.
enum class Notation { plain, rgb, sampled, blackbody };

struct TypeWord {
  std::string_view word;
  ParameterType type;
  int group = 1;  // numbers per value
  Notation notation = Notation::plain;
};

using enum ParameterType;
constexpr std::array<TypeWord, 17> type_words{{{"float", number},
                                               {"integer", integer},
                                               {"bool", boolean},
                                               {"string", string},
                                               {"point2", point2, 2},
                                               {"vector2", vector2, 2},
                                               {"point3", point3, 3},
                                               {"point", point3, 3},
                                               {"vector3", vector3, 3},
                                               {"vector", vector3, 3},
                                               {"normal3", normal, 3},
                                               {"normal", normal, 3},
                                               {"rgb", spectrum, 3, Notation::rgb},
                                               {"color", spectrum, 3, Notation::rgb},
                                               {"spectrum", spectrum, 1, Notation::sampled},
                                               {"blackbody", spectrum, 1, Notation::blackbody},
                                               {"texture", texture}}};

const TypeWord* find_type(std::string_view word) {
  for (const TypeWord& type : type_words)
    if (type.word == word) return &type;
  return nullptr;
}

struct Header {
  std::string_view type, name;
};

// The two words of "type name"; no value if there are not two.
std::optional<Header> split_header(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  std::size_t type_start = text.find_first_not_of(blanks);
  if (type_start == std::string_view::npos) return std::nullopt;
  std::size_t type_end = text.find_first_of(blanks, type_start);
  if (type_end == std::string_view::npos) return std::nullopt;
  std::size_t name_start = text.find_first_not_of(blanks, type_end);
  if (name_start == std::string_view::npos) return std::nullopt;
  std::size_t name_end = text.find_first_of(blanks, name_start);
  if (name_end != std::string_view::npos && text.find_first_not_of(blanks, name_end) != std::string_view::npos)
    return std::nullopt;
  return Header{text.substr(type_start, type_end - type_start), text.substr(name_start, name_end - name_start)};
}

bool looks_like_header(const Token& token) {
  if (token.kind != TokenKind::quoted) return false;
  auto header = split_header(token.text);
  return header && find_type(header->type);
}

// Reads the values of one parameter.
class ValueReader {
 public:
  ValueReader(const ParameterContext& context, const Token& header, std::string_view name, const TypeWord* type)
      : context_(context), header_(header), name_(printable(name)), type_(type) {}

  // Calls take(token) for every value; false if the list is malformed. Afterwards the position is after the list.
  template <class Take>
  bool each(Take take);
  std::optional<Values> read();

 private:
  template <class T, class Parse>
  std::optional<std::vector<T>> parsed(std::string_view what, Parse parse);
  std::optional<Values> read_spectrum();
  std::optional<Values> read_sampled();
  template <class T, int N>
  std::optional<Values> grouped();
  bool group_is_whole(std::size_t count, std::size_t group);
  bool may_be_quoted() const {
    return !type_ || type_->type == string || type_->type == texture || type_->notation == Notation::sampled;
  }
  void fail(const Token& token, std::string message, std::string hint = {}) {
    if (good_) context_.report.error(context_.lexer.where(token), std::move(message), std::move(hint));
    good_ = false;
  }

  const ParameterContext& context_;
  const Token& header_;
  std::string name_;
  const TypeWord* type_;
  bool good_ = true;
};

template <class Take>
bool ValueReader::each(Take take) {
  Lexer& lexer = context_.lexer;
  Token first = lexer.peek();
  bool bracketed = first.kind == TokenKind::open;
  if (bracketed) lexer.next();
  std::size_t count = 0;
  while (bracketed || count == 0) {
    const Token& token = lexer.peek();
    bool is_value = token.kind == TokenKind::number || token.kind == TokenKind::quoted ||
                    (token.kind == TokenKind::word && !is_directive(token.text));
    if (token.kind == TokenKind::close && bracketed) {
      lexer.next();
      break;
    }
    if (token.kind == TokenKind::unclosed_quote) {
      fail(lexer.next(), "a quoted string has no end on its line");
      return false;
    }
    if (!is_value || (!may_be_quoted() && looks_like_header(token))) {
      if (bracketed)
        fail(first, "the '[' of '" + name_ + "' is not closed; it is followed by " + describe(token));
      else
        fail(header_, "'" + name_ + "' has no value; " + describe(token) + " follows");
      if (token.kind == TokenKind::open) lexer.next();
      return false;
    }
    take(token);
    lexer.next();
    ++count;
  }
  if (count == 0) fail(first, "'" + name_ + "' has no value");
  return good_;
}

// All values by `parse`, which returns no value for an invalid token.
template <class T, class Parse>
std::optional<std::vector<T>> ValueReader::parsed(std::string_view what, Parse parse) {
  std::vector<T> values;
  bool whole = each([&](const Token& token) {
    if (std::optional<T> value = parse(token))
      values.push_back(std::move(*value));
    else
      fail(token, "'" + name_ + "' takes " + std::string(what) + "; found " + describe(token));
  });
  if (!whole || !good_) return std::nullopt;
  return values;
}

std::optional<float> float_of(const Token& token) {
  return token.kind == TokenKind::number ? to_float(token.text) : std::nullopt;
}
std::optional<int> integer_of(const Token& token) {
  return token.kind == TokenKind::number ? to_integer(token.text) : std::nullopt;
}
std::optional<std::string> string_of(const Token& token) {
  return token.kind == TokenKind::quoted ? std::optional(unescape(token.text)) : std::nullopt;
}
std::optional<std::uint8_t> boolean_of(const Token& token) {
  if (token.kind != TokenKind::word && token.kind != TokenKind::quoted) return std::nullopt;
  if (token.text == "true") return std::uint8_t{1};
  if (token.text == "false") return std::uint8_t{0};
  return std::nullopt;
}

constexpr std::string_view finite_numbers = "finite numbers";

bool ValueReader::group_is_whole(std::size_t count, std::size_t group) {
  if (count % group == 0) return true;
  fail(header_, "'" + name_ + "' takes " + (group == 2 ? "pairs" : "triples") + " of numbers; there are " +
                    std::to_string(count));
  return false;
}

template <class T, int N>
std::optional<Values> ValueReader::grouped() {
  auto flat = parsed<float>(finite_numbers, float_of);
  if (!flat || !group_is_whole(flat->size(), N)) return std::nullopt;
  std::vector<T> values(flat->size() / N);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if constexpr (N == 2)
      values[i] = {(*flat)[2 * i], (*flat)[2 * i + 1]};
    else
      values[i] = {(*flat)[3 * i], (*flat)[3 * i + 1], (*flat)[3 * i + 2]};
  }
  return Values(std::move(values));
}

std::optional<Values> ValueReader::read_sampled() {
  Lexer& lexer = context_.lexer;
  // Names and numbers must not be mixed: the first value decides.
  std::vector<float> pairs;
  std::vector<SpectrumValue> values;
  SourceLocation where = lexer.where(header_);
  bool whole = each([&](const Token& token) {
    if (token.kind == TokenKind::quoted) {
      auto value = named_spectrum(unescape(token.text), context_.folder, lexer.where(token), context_.report);
      if (value)
        values.push_back(std::move(*value));
      else
        good_ = false;
    } else if (auto value = float_of(token)) {
      pairs.push_back(*value);
    } else {
      fail(token, "'" + name_ + "' takes a named spectrum, a file or pairs of numbers; found " + describe(token));
    }
  });
  if (!whole || !good_) return std::nullopt;
  if (!values.empty() && !pairs.empty()) {
    fail(header_, "'" + name_ + "' takes names of spectra or pairs of numbers, not both");
    return std::nullopt;
  }
  if (!values.empty()) return Values(std::move(values));
  auto sampled = sampled_from_pairs(pairs, where, context_.report);
  if (!sampled) return std::nullopt;
  return Values(std::vector<SpectrumValue>{std::move(*sampled)});
}

std::optional<Values> ValueReader::read_spectrum() {
  if (type_->notation == Notation::sampled) return read_sampled();
  auto flat = parsed<float>(finite_numbers, float_of);
  if (!flat) return std::nullopt;
  std::vector<SpectrumValue> values;
  if (type_->notation == Notation::blackbody) {
    for (float kelvin : *flat) {
      if (!(kelvin > 0)) fail(header_, "the temperature of '" + name_ + "' must be positive, in kelvin");
      values.push_back(Blackbody{kelvin});
    }
    return good_ ? std::optional<Values>(std::move(values)) : std::nullopt;
  }
  if (!group_is_whole(flat->size(), 3)) return std::nullopt;
  for (std::size_t i = 0; i < flat->size(); i += 3)
    values.push_back(RgbValue{{(*flat)[i], (*flat)[i + 1], (*flat)[i + 2]}, context_.color_space});
  return Values(std::move(values));
}

std::optional<Values> wrapped(auto values) { return values ? std::optional<Values>(std::move(*values)) : std::nullopt; }

std::optional<Values> ValueReader::read() {
  switch (type_->type) {
    case number:
      return wrapped(parsed<float>(finite_numbers, float_of));
    case integer:
      return wrapped(parsed<int>("integers of 32 bits", integer_of));
    case boolean:
      return wrapped(parsed<std::uint8_t>("true or false", boolean_of));
    case string:
      return wrapped(parsed<std::string>("a quoted string", string_of));
    case point2:
    case vector2:
      return grouped<Vec2f, 2>();
    case point3:
    case vector3:
    case normal:
      return grouped<Vec3f, 3>();
    case spectrum:
      return read_spectrum();
    case texture: {
      auto names = parsed<std::string>("the quoted name of a texture", string_of);
      if (!names) return std::nullopt;
      if (names->size() != 1) {
        fail(header_, "'" + name_ + "' takes the name of one texture; found " + std::to_string(names->size()));
        return std::nullopt;
      }
      return Values(TextureName{names->front()});
    }
  }
  return std::nullopt;
}

std::vector<std::string_view> words_of_types() {
  std::vector<std::string_view> words;
  for (const TypeWord& type : type_words) words.push_back(type.word);
  return words;
}

// Numbers after an unbracketed value.
void skip_stray_numbers(const ParameterContext& context, std::string_view name) {
  if (context.lexer.peek().kind != TokenKind::number) return;
  context.report.error(context.lexer.where(context.lexer.peek()),
                       "more than one value of '" + printable(name) + "' needs brackets: [ ... ]");
  while (context.lexer.peek().kind == TokenKind::number) context.lexer.next();
}

}  // namespace

std::string_view spelling(ParameterType type) {
  switch (type) {
    case number:
      return "float";
    case integer:
      return "integer";
    case boolean:
      return "bool";
    case string:
      return "string";
    case point2:
      return "point2";
    case vector2:
      return "vector2";
    case point3:
      return "point3";
    case vector3:
      return "vector3";
    case normal:
      return "normal";
    case spectrum:
      return "rgb, spectrum or blackbody";
    case texture:
      return "texture";
  }
  return "";
}

ParameterList read_parameters(const ParameterContext& context) {
  ParameterList list;
  while (context.lexer.peek().kind == TokenKind::quoted) {
    Token header = context.lexer.next();
    SourceLocation where = context.lexer.where(header);
    auto words = split_header(header.text);
    const TypeWord* type = words ? find_type(words->type) : nullptr;
    ValueReader reader(context, header, words ? words->name : header.text, type);
    if (!type) {
      if (!words) {
        context.report.error(where, "a parameter is stated as \"type name\" value; found " + describe(header));
      } else {
        std::string_view near = nearest_name(words->type, words_of_types());
        context.report.error(where, "'" + printable(words->type) + "' is not a parameter type",
                             near.empty()
                                 ? "types are float, integer, bool, string, rgb, spectrum, texture, point3, ..."
                                 : "did you mean '" + std::string(near) + "'?");
      }
      reader.each([](const Token&) {});
      continue;
    }
    bool bracketed = context.lexer.peek().kind == TokenKind::open;
    auto values = reader.read();
    if (!bracketed) skip_stray_numbers(context, words->name);
    if (!values) continue;
    std::string name(words->name);
    if (list.find(name)) {
      context.report.error(where, "'" + printable(name) + "' is stated twice");
      continue;
    }
    list.add({std::move(name), type->type, std::move(*values), where});
  }
  return list;
}

}  // namespace montelux::pbrt
