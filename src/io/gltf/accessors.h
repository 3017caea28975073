// Arrays of numbers in the buffers of a glTF document.
#pragma once
#include "io/gltf/document.h"

namespace montelux::gltf {

// What an accessor may be for a given use.
struct AccessorUse {
  std::vector<std::string_view> types;  // "SCALAR", "VEC3", ...
  bool integers = false;                // unsigned integers unchanged; else reals, normalised if stated
};

struct Numbers {
  std::size_t count = 0;           // of elements
  std::size_t components = 0;      // of each
  std::vector<float> values;       // if used as reals
  std::vector<std::uint32_t> all;  // if used as integers

  const float* at(std::size_t i) const { return values.data() + i * components; }
  Vec3f vec3(std::size_t i) const { return {at(i)[0], at(i)[1], at(i)[2]}; }
};

// Reads the accessor whose number `user` states, including its sparse part. Nothing, and an error, if the
// number or anything about the accessor is wrong: everything is inside its buffers, and reals are finite.
std::optional<Numbers> read_accessor(Document& document, const Element& user, const AccessorUse& use);

}  // namespace montelux::gltf
