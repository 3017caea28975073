#include "parameter/setting_text.h"

#include <fmt/format.h>

namespace montelux {

std::string setting_text(bool value) { return value ? "on" : "off"; }
std::string setting_text(int value) { return fmt::format("{}", value); }
std::string setting_text(float value) { return fmt::format("{}", value); }
std::string setting_text(const TextureName& value) { return value.name; }
std::string setting_text(Vec3f value) { return fmt::format("{} {} {}", value.x, value.y, value.z); }
std::string setting_text(const SpectrumValue& value) {
  if (const auto* name = std::get_if<NamedSpectrum>(&value)) return name->name;
  if (const auto* blackbody = std::get_if<Blackbody>(&value)) return setting_text(blackbody->kelvin);
  if (const auto* rgb = std::get_if<RgbValue>(&value)) {
    const Rgb& c = rgb->rgb;
    return c[0] == c[1] && c[1] == c[2] ? setting_text(c[0]) : setting_text(Vec3f{c[0], c[1], c[2]});
  }
  std::string text;
  const auto& sampled = std::get<SampledValue>(value);
  for (std::size_t i = 0; i < sampled.values.size(); ++i)
    text += fmt::format("{}{} {}", i ? " " : "", sampled.wavelengths[i], sampled.values[i]);
  return text;
}

Parameter parameter_of(std::string_view name, bool value) {
  return {std::string(name), ParameterType::boolean, std::vector<std::uint8_t>{std::uint8_t(value)}, {}};
}
Parameter parameter_of(std::string_view name, int value) { return parameter_of(name, std::vector<int>{value}); }
Parameter parameter_of(std::string_view name, float value) { return parameter_of(name, std::vector<float>{value}); }
Parameter parameter_of(std::string_view name, std::string value) {
  return parameter_of(name, std::vector<std::string>{std::move(value)});
}
Parameter parameter_of(std::string_view name, SpectrumValue value) {
  return {std::string(name), ParameterType::spectrum, std::vector<SpectrumValue>{std::move(value)}, {}};
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

}  // namespace montelux
