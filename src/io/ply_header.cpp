#include "io/ply_header.h"

#include <array>
#include <charconv>
#include <optional>

#include "io/text_file.h"

namespace montelux::ply {

namespace {

std::optional<Type> type_of(std::string_view word) {
  struct Name {
    std::string_view word;
    Type type;
  };
  static constexpr std::array<Name, 16> names{{{"char", Type::int8},
                                               {"int8", Type::int8},
                                               {"uchar", Type::uint8},
                                               {"uint8", Type::uint8},
                                               {"short", Type::int16},
                                               {"int16", Type::int16},
                                               {"ushort", Type::uint16},
                                               {"uint16", Type::uint16},
                                               {"int", Type::int32},
                                               {"int32", Type::int32},
                                               {"uint", Type::uint32},
                                               {"uint32", Type::uint32},
                                               {"float", Type::float32},
                                               {"float32", Type::float32},
                                               {"double", Type::float64},
                                               {"float64", Type::float64}}};
  for (const Name& name : names)
    if (name.word == word) return name.type;
  return std::nullopt;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view blanks = " \t\r";
  for (std::size_t start = line.find_first_not_of(blanks); start != std::string_view::npos;) {
    std::size_t end = std::min(line.find_first_of(blanks, start), line.size());
    words.push_back(line.substr(start, end - start));
    start = line.find_first_not_of(blanks, end);
  }
  return words;
}

using Words = std::vector<std::string_view>;

Status take_format(const Words& words, Header& header) {
  std::string_view name = words.size() > 1 ? words[1] : "";
  if (name == "ascii")
    header.format = Format::text;
  else if (name == "binary_little_endian")
    header.format = Format::little_endian;
  else if (name == "binary_big_endian")
    header.format = Format::big_endian;
  else
    return Failure{"unknown format '" + printable(name) + "'"};
  return Done{};
}

Status take_element(const Words& words, Header& header) {
  std::size_t count = 0;
  if (words.size() < 3) return Failure{"an element without a name or count"};
  auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), count);
  if (error != std::errc() || end != words[2].data() + words[2].size())
    return Failure{"'" + printable(words[2]) + "' is not an element count"};
  header.elements.push_back({std::string(words[1]), count, {}});
  return Done{};
}

Status take_property(const Words& words, Header& header) {
  if (header.elements.empty()) return Failure{"a property before any element"};
  bool is_list = words.size() > 1 && words[1] == "list";
  if (words.size() < (is_list ? 5u : 3u)) return Failure{"a property without a type or name"};
  auto type = type_of(is_list ? words[3] : words[1]);
  auto count_type = is_list ? type_of(words[2]) : Type::uint8;
  if (!type || !count_type) return Failure{"unknown type of property '" + printable(words.back()) + "'"};
  header.elements.back().properties.push_back({std::string(words[is_list ? 4 : 2]), *type, is_list, *count_type});
  return Done{};
}

Status take_line(const Words& words, Header& header) {
  if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return Done{};
  if (words[0] == "format") return take_format(words, header);
  if (words[0] == "element") return take_element(words, header);
  if (words[0] == "property") return take_property(words, header);
  return Failure{"unknown word '" + printable(words[0]) + "' in the header"};
}

}  // namespace

Result<Header> read_header(std::string_view bytes) {
  Header header;
  bool has_format = false;
  for (std::size_t at = 0, line_number = 0;; ++line_number) {
    std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos) return Failure{"its header has no end"};
    Words words = words_of(bytes.substr(at, end - at));
    at = end + 1;
    if (line_number == 0) {
      if (words.empty() || words[0] != "ply") return Failure{"it does not begin with 'ply'"};
      continue;
    }
    if (!words.empty() && words[0] == "end_header") {
      header.size = at;
      if (!has_format) return Failure{"its header states no format"};
      return header;
    }
    has_format |= !words.empty() && words[0] == "format";
    Status status = take_line(words, header);
    if (!status) return status.failure();
  }
}

}  // namespace montelux::ply
