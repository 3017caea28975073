// A thing of a table as a person types it: "vegas:iterations=5,bins=50", or a name with key=value pairs beside it.
#pragma once
#include "math/result.h"
#include "parameter/spec.h"

namespace montelux {

using Setting = std::pair<std::string, std::string>;  // name, value as text

// What was typed, not yet held against a table.
struct ChoiceText {
  std::string name;
  std::vector<Setting> settings;
};

// Splits "name" or "name:key=value,key=value". Fails where a part is not key=value. Commas within parentheses do not
// separate.
Result<ChoiceText> parse_choice(std::string_view text);

// The typed values of the settings. Fails with one message that names everything that is wrong: unknown names (with the
// nearest valid one), values of another type, out of range, or not among the choices (likewise). `none` is taken by
// parameters whose choices hold "none", whatever their type; it is left out of the list.
Result<ParameterList> read_settings(const EntitySpec& entity, const std::vector<Setting>& settings,
                                    std::string_view family);

// "unknown integrator "pth"; valid: path, direct (did you mean "path"?)".
Failure unknown_name(std::string_view family, std::string_view name, const std::vector<std::string_view>& valid);

}  // namespace montelux
