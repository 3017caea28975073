// The values of fields as text and as parameters.
#pragma once
#include <array>
#include <string>

#include "parameter/input.h"

namespace montelux {

// Values as a person types them: "on", "0.001".
std::string setting_text(bool value);
std::string setting_text(int value);
std::string setting_text(float value);
std::string setting_text(const TextureName& value);
std::string setting_text(Vec3f value);                 // "0 0 1"
std::string setting_text(const SpectrumValue& value);  // "0.5", "0.25 0.5 1", "metal-Cu-eta", "6500"
template <std::size_t N>
std::string setting_text(const std::array<float, N>& values) {
  std::string text;
  for (float value : values) {
    if (!text.empty()) text += ' ';
    text += setting_text(value);
  }
  return text;
}
template <class... T>
std::string setting_text(const Input<T...>& input) {
  return std::visit([](const auto& v) { return setting_text(v); }, input.value);
}

// Values as parameters.
Parameter parameter_of(std::string_view name, bool value);
Parameter parameter_of(std::string_view name, int value);
Parameter parameter_of(std::string_view name, float value);
Parameter parameter_of(std::string_view name, std::string value);
Parameter parameter_of(std::string_view name, SpectrumValue value);
Parameter parameter_of(std::string_view name, std::vector<int> values);
Parameter parameter_of(std::string_view name, std::vector<float> values);
Parameter parameter_of(std::string_view name, std::vector<std::string> values);
template <class T, std::size_t N>
Parameter parameter_of(std::string_view name, const std::array<T, N>& values) {
  return parameter_of(name, std::vector<T>(values.begin(), values.end()));
}
template <class... T>
Parameter parameter_of(std::string_view name, const Input<T...>& input) {
  return InputConversion<Input<T...>>::write(name, input);
}

}  // namespace montelux
