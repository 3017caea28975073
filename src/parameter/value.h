// Typed parameters as a scene file states them: plain data, writable again.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "color/spectrum.h"
#include "math/vec.h"
#include "parameter/diagnostic.h"

namespace montelux {

// A colour or spectrum as stated; it becomes an Rgb when the scene is prepared, by what it is used for.
struct RgbValue {
  Rgb rgb;                           // components in `color_space`
  std::string color_space = "srgb";  // srgb, dci-p3, rec2020, aces2065-1
};
struct NamedSpectrum {
  std::string name;  // as "metal-Cu-eta"
};
struct SampledValue {
  std::vector<float> wavelengths;  // nm, rising
  std::vector<float> values;       // one a wavelength
};
struct Blackbody {
  float kelvin;
};
using SpectrumValue = std::variant<RgbValue, NamedSpectrum, SampledValue, Blackbody>;

struct TextureName {
  std::string name;
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

// The parameters of one entity, in the order stated; names are unique per (name). A list keeps account of what has been
// looked up, so that a parameter that nothing uses is reported and never ignored; it is for one thread at a time.
class ParameterList {
 public:
  void add(Parameter parameter) { list_.push_back(std::move(parameter)); }
  const std::vector<Parameter>& all() const { return list_; }
  // Null where absent. The last of equal names wins. The parameter counts as used, as it does by all that follow.
  const Parameter* find(std::string_view name) const;

  // What nothing has looked up since it was added, or since the last call of forget_uses().
  std::vector<const Parameter*> unused() const;
  // After looks that only checked.
  void forget_uses() const;
  // What is accounted for elsewhere: one parameter, or all of an entity that is left out on purpose.
  void use(std::string_view name) const { find(name); }
  void use_all() const;

  // The first value of the parameter, or `otherwise` where it is absent or of another type (the parser has reported
  // that).
  float number(std::string_view name, float otherwise) const;
  int integer(std::string_view name, int otherwise) const;
  bool boolean(std::string_view name, bool otherwise) const;
  std::string string(std::string_view name, std::string otherwise) const;
  Vec3f vec3(std::string_view name, Vec3f otherwise) const;
  std::optional<SpectrumValue> spectrum(std::string_view name) const;
  std::optional<std::string> texture(std::string_view name) const;

  // The whole array; empty where absent.
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

// A thing of a family ("conductor" of the materials) with its parameters.
struct Entity {
  std::string type;
  ParameterList parameters;
  SourceLocation where;
};

}  // namespace montelux
