// Parameters of entities, as stated by the glTF reader.
#pragma once
#include "parameter/value.h"

namespace montelux::gltf {

inline void put_number(Entity& e, std::string name, double x) {
  e.parameters.add({std::move(name), ParameterType::number, std::vector<float>{float(x)}, e.where});
}
inline void put_numbers(Entity& e, std::string name, std::vector<float> x) {
  e.parameters.add({std::move(name), ParameterType::number, std::move(x), e.where});
}
inline void put_integer(Entity& e, std::string name, int x) {
  e.parameters.add({std::move(name), ParameterType::integer, std::vector<int>{x}, e.where});
}
inline void put_boolean(Entity& e, std::string name, bool x) {
  e.parameters.add({std::move(name), ParameterType::boolean, std::vector<std::uint8_t>{std::uint8_t(x)}, e.where});
}
inline void put_string(Entity& e, std::string name, std::string x) {
  e.parameters.add({std::move(name), ParameterType::string, std::vector<std::string>{std::move(x)}, e.where});
}
inline void put_strings(Entity& e, std::string name, std::vector<std::string> x) {
  e.parameters.add({std::move(name), ParameterType::string, std::move(x), e.where});
}
inline void put_point(Entity& e, std::string name, Vec3f x) {
  e.parameters.add({std::move(name), ParameterType::point3, std::vector<Vec3f>{x}, e.where});
}
// Linear, in the primaries of sRGB.
inline void put_rgb(Entity& e, std::string name, const Rgb& x) {
  e.parameters.add(
      {std::move(name), ParameterType::spectrum, std::vector<SpectrumValue>{RgbValue{x, "srgb"}}, e.where});
}
inline void put_texture(Entity& e, std::string name, std::string texture) {
  e.parameters.add({std::move(name), ParameterType::texture, TextureName{std::move(texture)}, e.where});
}

}  // namespace montelux::gltf
