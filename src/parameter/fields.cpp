#include "parameter/fields.h"

#include <fmt/format.h>

namespace montelux {

std::string setting_text(bool value) { return value ? "on" : "off"; }
std::string setting_text(int value) { return fmt::format("{}", value); }
std::string setting_text(float value) { return fmt::format("{:g}", value); }

ParameterSpec with_default(ParameterSpec row, const std::string& value) {
  row.meaning += "; default " + value;
  return row;
}

}  // namespace montelux
