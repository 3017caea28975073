// Arrays of numbers in the buffers of a glTF document.
#pragma once
#include "io/gltf/document.h"

namespace montelux::gltf {

// What a use of an accessor takes.
struct AccessorUse {
  std::vector<std::string_view> types;  // "SCALAR", "VEC3", ...
  bool integers = false;  // whole numbers as they are, without a sign; else reals, normalised where stated
};

struct Numbers {
  std::size_t count = 0;           // of elements
  std::size_t components = 0;      // of each
  std::vector<float> values;       // of a use as reals
  std::vector<std::uint32_t> all;  // of a use as integers

  const float* at(std::size_t i) const { return values.data() + i * components; }
  Vec3f vec3(std::size_t i) const { return {at(i)[0], at(i)[1], at(i)[2]}; }
};

// Reads the accessor whose number `user` states, with what its sparse part replaces. Nothing, and an error, where the
// number or anything about the accessor is wrong: everything is inside of its buffers, and reals are finite.
std::optional<Numbers> read_accessor(Document& document, const Element& user, const AccessorUse& use);

}  // namespace montelux::gltf
