// JSON as a tree with the position of each value.
#pragma once
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "math/result.h"

namespace montelux::gltf {

struct JsonMember;

struct JsonValue {
  enum class Kind { null, boolean, number, text, list, object };
  Kind kind = Kind::null;
  bool boolean = false;
  double number = 0;
  std::string text;
  std::vector<JsonValue> items;     // of a list
  std::vector<JsonMember> members;  // of an object, in the order of the file
  int line = 0, column = 0;         // from 1: the end of the value, or the beginning of its list or object

  // Null if the object has no such member, or if this is not an object.
  const JsonValue* find(std::string_view name) const;
};

struct JsonMember {
  std::string name;
  JsonValue value;
};

// What is wrong with a text that is not JSON, and where.
struct JsonProblem {
  std::string message;
  int line = 0, column = 0;
};

// Nesting deeper than 200 is a problem, too.
std::variant<JsonValue, JsonProblem> parse_json(std::string_view text);

}  // namespace montelux::gltf
