// Parts of a document that the user selects by name or number.
#pragma once
#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf/document.h"
#include "io/text_file.h"

namespace montelux::gltf {

// The value of a text that consists of a whole number only.
inline std::optional<std::size_t> as_number(const std::string& text) {
  std::size_t n = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), n);
  if (text.empty() || problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return n;
}

// "there is no `kind` 'choice'", with the valid ones and the closest of them.
inline void report_no_such(const Document& document, const std::string& kind, const std::string& choice,
                           std::size_t count, const std::vector<std::string>& names) {
  std::string hint = count == 0 ? "there is none" : "valid: numbers from 0 to " + std::to_string(count - 1);
  std::vector<std::string_view> once;
  for (const std::string& name : names)
    if (!name.empty() && std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  for (std::string_view name : once) hint += ", " + printable(name);
  const std::string_view nearest = nearest_name(choice, once);
  if (!nearest.empty()) hint += " (did you mean '" + printable(nearest) + "'?)";
  document.report().error(document.whole(), "there is no " + kind + " '" + printable(choice) + "' in the scene", hint);
}

}  // namespace montelux::gltf
