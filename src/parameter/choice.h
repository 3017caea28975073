// An entry of a table as a user types it: "vegas:iterations=5,bins=50", or a name with separate key=value pairs.
#pragma once
#include "math/result.h"
#include "parameter/spec.h"

namespace montelux {

using Setting = std::pair<std::string, std::string>;  // name, value as text

// The typed text, not yet checked against a table.
struct ChoiceText {
  std::string name;
  std::vector<Setting> settings;
};

// Splits "name" or "name:key=value,key=value". Fails if a part is not key=value. Commas within parentheses do not
// separate.
Result<ChoiceText> parse_choice(std::string_view text);

// The settings by the present names of their parameters, where they are stated by earlier ones.
std::vector<Setting> with_present_names(const EntitySpec& entity, std::vector<Setting> settings);

// The typed values of the settings, which may have earlier names. Fails with one message that lists everything that is
// wrong: unknown names (with the closest valid one), values of another type, out of range, or not among the choices
// (likewise). `none` is accepted by parameters whose choices contain "none", whatever their type, and is omitted from
// the list.
Result<ParameterList> read_settings(const EntitySpec& entity, const std::vector<Setting>& settings,
                                    std::string_view family);

// "unknown integrator "pth"; valid: path, direct (did you mean "path"?)".
Failure unknown_name(std::string_view family, std::string_view name, const std::vector<std::string_view>& valid);

}  // namespace montelux
