// The header of a PLY file.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "math/result.h"

namespace montelux::ply {

enum class Format { text, little_endian, big_endian };
enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::size_t size_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::float64:
      return 8;
    default:
      return 4;
  }
}

struct Property {
  std::string name;
  Type type;
  bool is_list = false;
  Type count_type = Type::uint8;  // of a list
};

struct Element {
  std::string name;
  std::size_t count;
  std::vector<Property> properties;
};

struct Header {
  Format format = Format::text;
  std::vector<Element> elements;
  std::size_t size = 0;  // bytes before the body
};

// Fails with a description of what is wrong.
Result<Header> read_header(std::string_view bytes);

}  // namespace montelux::ply
