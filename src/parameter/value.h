// Typed parameters as stated in a scene file: plain data that can be written again.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "color/rgb.h"
#include "math/vec.h"
#include "parameter/diagnostic.h"

namespace montelux {

// A colour or spectrum as stated; it becomes an Rgb when the scene is prepared, depending on its use.
struct RgbValue {
  Rgb rgb;                           // components in `color_space`
  std::string color_space = "srgb";  // srgb, dci-p3, rec2020, aces2065-1
};
inline bool operator==(const RgbValue& a, const RgbValue& b) {
  return a.rgb[0] == b.rgb[0] && a.rgb[1] == b.rgb[1] && a.rgb[2] == b.rgb[2] && a.color_space == b.color_space;
}
struct NamedSpectrum {
  std::string name;  // for example "metal-Cu-eta"
  bool operator==(const NamedSpectrum&) const = default;
};
struct SampledValue {
  std::vector<float> wavelengths;  // nm, increasing
  std::vector<float> values;       // one per wavelength
  bool operator==(const SampledValue&) const = default;
};
struct Blackbody {
  float kelvin;
  bool operator==(const Blackbody&) const = default;
};
using SpectrumValue = std::variant<RgbValue, NamedSpectrum, SampledValue, Blackbody>;

// The same value of all components.
inline SpectrumValue gray_value(float x) { return RgbValue{gray_rgb(x)}; }

struct TextureName {
  std::string name;
  bool operator==(const TextureName&) const = default;
};

enum class ParameterType {
  number,
  integer,
  boolean,
  string,
  point2,
  vector2,
  point3,
  vector3,
  normal,
  spectrum,
  texture
};

// Every value is an array; a single value is an array of one.
using Values = std::variant<std::vector<float>, std::vector<int>, std::vector<std::uint8_t>, std::vector<std::string>,
                            std::vector<Vec2f>, std::vector<Vec3f>, std::vector<SpectrumValue>, TextureName>;

struct Parameter {
  std::string name;
  ParameterType type;
  Values values;
  SourceLocation where;
  mutable bool used = false;  // whether anything has looked it up, see ParameterList::unused()
};

// The parameters of one entity, in the order stated; names are unique. A list records which parameters have been
// looked up, so that an unused parameter is reported and never silently ignored; it is for one thread at a time.
class ParameterList {
 public:
  void add(Parameter parameter) { list_.push_back(std::move(parameter)); }
  const std::vector<Parameter>& all() const { return list_; }
  // Null if absent. The last of equal names wins. Like all functions below, it marks the parameter as used.
  const Parameter* find(std::string_view name) const;

  // The parameters that have not been looked up since they were added, or since the last call of forget_uses().
  std::vector<const Parameter*> unused() const;
  // To be called after look-ups that only check.
  void forget_uses() const;
  // The same for one parameter: its value was read, and has no effect.
  void forget_use(std::string_view name) const;
  // Marks what is handled elsewhere: one parameter, or all of an entity that is omitted on purpose.
  void use(std::string_view name) const { find(name); }
  void use_all() const;

  // The first value of the parameter, or `otherwise` if it is absent or of another type (which the parser has
  // reported).
  float number(std::string_view name, float otherwise) const;
  int integer(std::string_view name, int otherwise) const;
  bool boolean(std::string_view name, bool otherwise) const;
  std::string string(std::string_view name, std::string otherwise) const;
  Vec3f vec3(std::string_view name, Vec3f otherwise) const;
  std::optional<SpectrumValue> spectrum(std::string_view name) const;
  std::optional<std::string> texture(std::string_view name) const;

  // The whole array; empty if absent.
  template <class T>
  const std::vector<T>& array(std::string_view name) const {
    static const std::vector<T> none;
    const Parameter* p = find(name);
    const auto* values = p ? std::get_if<std::vector<T>>(&p->values) : nullptr;
    return values ? *values : none;
  }

 private:
  std::vector<Parameter> list_;
};

// An entry of a family ("conductor" of the materials) with its parameters.
struct Entity {
  std::string type;
  ParameterList parameters;
  SourceLocation where;
};

}  // namespace montelux
