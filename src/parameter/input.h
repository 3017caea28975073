// Parameters that may be stated in several ways: as a number, as a spectrum, or by the name of a texture.
#pragma once
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "parameter/value.h"

namespace montelux {

// One of the alternatives, and where it was stated. Equality is that of the values.
template <class... T>
struct Input {
  std::variant<T...> value;
  SourceLocation where{};

  Input() = default;
  template <class V>
  requires(std::is_same_v<std::decay_t<V>, T> || ...) Input(V&& v, SourceLocation place = {})
      : value(std::forward<V>(v)), where(std::move(place)) {}
  Input(const RgbValue& v) requires(std::is_same_v<SpectrumValue, T> || ...) : value(SpectrumValue(v)) {}

  template <class V>
  const V* get() const {
    return std::get_if<V>(&value);
  }
  friend bool operator==(const Input& a, const Input& b) { return a.value == b.value; }
};

// What may vary over a surface.
using NumberInput = Input<float, TextureName>;
using SpectrumInput = Input<SpectrumValue, TextureName>;
// What is the same everywhere.
using ConstantInput = Input<float, SpectrumValue>;
// An index of refraction: one for all wavelengths, or a spectrum.
using IndexInput = ConstantInput;
// What a texture of numbers or of spectra combines.
using ValueInput = Input<float, SpectrumValue, TextureName>;

// The type of the parameter that states an alternative.
template <class V>
constexpr ParameterType type_of_alternative() {
  if constexpr (std::is_same_v<V, float>)
    return ParameterType::number;
  else if constexpr (std::is_same_v<V, SpectrumValue>)
    return ParameterType::spectrum;
  else
    return ParameterType::texture;
}

// Conversions to and from parameters. No value: the parameter is of a type that the input does not have.
template <class I>
struct InputConversion;
template <class... T>
struct InputConversion<Input<T...>> {
  static std::vector<ParameterType> types() { return {type_of_alternative<T>()...}; }

  static std::optional<Input<T...>> read(const Parameter& stated) {
    std::optional<Input<T...>> result;
    (void)(read_as<T>(stated, result) || ...);
    return result;
  }
  static Parameter write(std::string_view name, const Input<T...>& input) {
    return std::visit(
        [&]<class V>(const V& v) {
          if constexpr (std::is_same_v<V, TextureName>)
            return Parameter{std::string(name), ParameterType::texture, v, input.where};
          else
            return Parameter{std::string(name), type_of_alternative<V>(), std::vector<V>{v}, input.where};
        },
        input.value);
  }

 private:
  template <class V>
  static bool read_as(const Parameter& stated, std::optional<Input<T...>>& result) {
    if constexpr (std::is_same_v<V, TextureName>) {
      if (const auto* v = std::get_if<V>(&stated.values)) result.emplace(*v, stated.where);
    } else {
      if (const auto* v = std::get_if<std::vector<V>>(&stated.values); v && !v->empty())
        result.emplace(v->front(), stated.where);
    }
    return result.has_value();
  }
};

}  // namespace montelux
