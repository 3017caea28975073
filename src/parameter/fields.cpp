#include "parameter/fields.h"

#include <fmt/format.h>

namespace montelux {

std::string setting_text(bool value) { return value ? "on" : "off"; }
std::string setting_text(int value) { return fmt::format("{}", value); }
std::string setting_text(float value) { return fmt::format("{}", value); }
Parameter parameter_of(std::string_view name, bool value) {
  return {std::string(name), ParameterType::boolean, std::vector<std::uint8_t>{std::uint8_t(value)}, {}};
}
Parameter parameter_of(std::string_view name, int value) { return parameter_of(name, std::vector<int>{value}); }
Parameter parameter_of(std::string_view name, float value) { return parameter_of(name, std::vector<float>{value}); }
Parameter parameter_of(std::string_view name, std::string value) {
  return parameter_of(name, std::vector<std::string>{std::move(value)});
}
Parameter parameter_of(std::string_view name, std::vector<int> values) {
  return {std::string(name), ParameterType::integer, std::move(values), {}};
}
Parameter parameter_of(std::string_view name, std::vector<float> values) {
  return {std::string(name), ParameterType::number, std::move(values), {}};
}
Parameter parameter_of(std::string_view name, std::vector<std::string> values) {
  return {std::string(name), ParameterType::string, std::move(values), {}};
}

ParameterSpec with_default(ParameterSpec row, const std::string& value) {
  row.meaning += "; default " + value;
  return row;
}

}  // namespace montelux
