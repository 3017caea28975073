#include "parameter/choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace montelux {

namespace {

// Splits at the commas that are not within parentheses.
std::vector<std::string> split_at_commas(std::string_view text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth <= 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

template <class T>
std::optional<T> read_whole(std::string_view text) {
  T value{};
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string range_text(const ParameterSpec& spec) {
  const bool from = spec.low > -1e30, to = spec.high < 1e30 && spec.high != 2147483647;
  if (from && to) return fmt::format(" from {:g} to {:g}", spec.low, spec.high);
  if (from) return fmt::format(" from {:g}", spec.low);
  if (to) return fmt::format(" up to {:g}", spec.high);
  return {};
}

// The accepted values of a parameter, for a message.
std::string expected(const ParameterSpec& spec) {
  std::vector<std::string> ways;
  for (ParameterType type : spec.types) switch (type) {
      case ParameterType::integer:
        ways.push_back("a whole number" + range_text(spec));
        break;
      case ParameterType::number:
        ways.push_back("a number" + range_text(spec));
        break;
      case ParameterType::boolean:
        ways.push_back("true or false");
        break;
      default:
        if (spec.choices.empty()) ways.push_back("text");
    }
  if (!spec.choices.empty()) ways.push_back(fmt::format("{}", fmt::join(spec.choices, ", ")));
  return fmt::format("{}", fmt::join(ways, ", or "));
}

bool in_range(const ParameterSpec& spec, int value) { return value >= spec.low && value <= spec.high; }
// The ends as numbers of the same precision, so that they are within.
bool in_range(const ParameterSpec& spec, float value) {
  return std::isfinite(value) && value >= float(spec.low) && value <= float(spec.high);
}

using TypedValues = std::pair<ParameterType, Values>;

// The value in the first of the parameter's types that can hold it.
std::optional<TypedValues> read_value(const ParameterSpec& spec, const std::string& text) {
  for (ParameterType type : spec.types) {
    if (type == ParameterType::integer) {
      if (auto value = read_whole<int>(text); value && in_range(spec, *value))
        return TypedValues{type, std::vector<int>{*value}};
    } else if (type == ParameterType::number) {
      if (auto value = read_whole<float>(text); value && in_range(spec, *value))
        return TypedValues{type, std::vector<float>{*value}};
    } else if (type == ParameterType::boolean) {
      if (text == "true" || text == "on") return TypedValues{type, std::vector<std::uint8_t>{1}};
      if (text == "false" || text == "off") return TypedValues{type, std::vector<std::uint8_t>{0}};
    } else if (spec.choices.empty() || std::ranges::find(spec.choices, text) != spec.choices.end()) {
      return TypedValues{type, std::vector<std::string>{text}};
    }
  }
  return std::nullopt;
}

}  // namespace

Result<ChoiceText> parse_choice(std::string_view text) {
  const std::size_t colon = text.find(':');
  ChoiceText choice{std::string(text.substr(0, colon)), {}};
  if (choice.name.empty()) return Failure{fmt::format("a name is missing in \"{}\"", text)};
  if (colon == std::string_view::npos) return choice;
  for (const std::string& part : split_at_commas(text.substr(colon + 1))) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == part.size())
      return Failure{fmt::format("\"{}\" in \"{}\" is not key=value", part, text)};
    choice.settings.emplace_back(part.substr(0, equals), part.substr(equals + 1));
  }
  return choice;
}

std::vector<Setting> with_present_names(const EntitySpec& entity, std::vector<Setting> settings) {
  for (auto& [name, text] : settings) {
    if (find_parameter(entity, name)) continue;
    for (const ParameterSpec& spec : entity.parameters)
      if (!spec.formerly.empty() && spec.formerly == name) name = spec.name;
  }
  return settings;
}

Result<ParameterList> read_settings(const EntitySpec& entity, const std::vector<Setting>& stated,
                                    std::string_view family) {
  const std::vector<Setting> settings = with_present_names(entity, stated);
  ParameterList list;
  std::string wrong;
  const auto complain = [&](const std::string& message) { wrong += (wrong.empty() ? "" : "; ") + message; };
  for (const auto& [name, text] : settings) {
    const ParameterSpec* spec = find_parameter(entity, name);
    if (!spec) {
      std::vector<std::string_view> names;
      for (const ParameterSpec& p : entity.parameters) names.push_back(p.name);
      const std::string what = fmt::format("setting of the {} {}", entity.name, family);
      complain(names.empty() ? fmt::format("the {} {} has no settings; found \"{}\"", entity.name, family, name)
                             : unknown_name(what, name, names).message);
      continue;
    }
    const bool may_be_none = std::ranges::find(spec->choices, "none") != spec->choices.end();
    if (may_be_none && text == "none" && spec->types.front() != ParameterType::string) continue;
    if (auto typed = read_value(*spec, text))
      list.add({name, typed->first, std::move(typed->second), {}});
    else
      complain(fmt::format("{} takes {}; found \"{}\"{}", name, expected(*spec), text,
                           did_you_mean(text, {spec->choices.begin(), spec->choices.end()})));
  }
  if (!wrong.empty()) return Failure{wrong};
  return list;
}

Failure unknown_name(std::string_view family, std::string_view name, const std::vector<std::string_view>& valid) {
  const std::string message = fmt::format("unknown {} \"{}\"; valid: {}", family, name, fmt::join(valid, ", "));
  return {message + did_you_mean(name, valid)};
}

}  // namespace montelux
