// JSON as text, with strings of arbitrary bytes.
#pragma once
#include <string>
#include <utility>

#include "io/text_file.h"

namespace montelux {

// Converts every string and key of a value to UTF-8, like as_utf8(). `Json` is the JSON library's value.
template <class Json>
void make_utf8(Json& json) {
  if (json.is_string()) {
    auto& text = json.template get_ref<std::string&>();
    if (!is_utf8(text)) text = as_utf8(text);
  } else if (json.is_object()) {
    Json valid = Json::object();
    for (auto& [key, value] : json.items()) {
      make_utf8(value);
      valid[as_utf8(key)] = std::move(value);
    }
    json = std::move(valid);
  } else if (json.is_array()) {
    for (auto& value : json) make_utf8(value);
  }
}

// The text of a value, indented if `indent` is not negative. Unlike dump() it accepts file names that are not UTF-8.
template <class Json>
std::string json_text(Json json, int indent = -1) {
  make_utf8(json);
  return json.dump(indent);
}

}  // namespace montelux
