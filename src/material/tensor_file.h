// Arrays of numbers by name, as in the files *.bsdf of the RGL material database (Dupuy and Jakob 2018): "tensor_file"
// and a zero, version 1.0, the number of fields; for each its name, number of dimensions, type, offset and sizes. All
// numbers are little-endian.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "math/result.h"

namespace montelux {

// By the numbers that files have.
enum class TensorType : std::uint8_t {
  uint8 = 1,
  int8,
  uint16,
  int16,
  uint32,
  int32,
  uint64,
  int64,
  float16,
  float32,
  float64
};

struct TensorField {
  std::string name;
  TensorType type;
  std::vector<std::uint64_t> sizes;  // along each dimension; the last one is contiguous
  std::string_view bytes;            // of all elements, at any alignment
};

// The fields, which refer to `bytes`; all lie within it. An error states what is wrong and at which byte.
Result<std::vector<TensorField>> read_tensor_file(std::string_view bytes);

}  // namespace montelux
