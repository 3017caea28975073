#include "io/gltf/accessors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace montelux::gltf {

namespace {

struct ComponentType {
  int code;
  std::size_t size;
};
constexpr std::array<ComponentType, 6> component_types{
    {{5120, 1}, {5121, 1}, {5122, 2}, {5123, 2}, {5125, 4}, {5126, 4}}};

constexpr std::array<std::string_view, 7> type_names{"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
std::size_t components_of(std::string_view type) {
  constexpr std::array<std::size_t, 7> counts{1, 2, 3, 4, 4, 9, 16};
  return counts[std::size_t(std::find(type_names.begin(), type_names.end(), type) - type_names.begin())];
}

template <class T>
T value_at(const std::uint8_t* p) {
  T x;
  std::memcpy(&x, p, sizeof x);
  return x;
}

// One component as a real; normalised integers are converted by glTF 2.0, 3.6.2.2.
float real_at(const std::uint8_t* p, int code, bool normalized) {
  const auto scaled = [&](float x, float max_value) { return normalized ? std::max(x / max_value, -1.0f) : x; };
  switch (code) {
    case 5120:
      return scaled(float(value_at<std::int8_t>(p)), 127);
    case 5121:
      return scaled(float(value_at<std::uint8_t>(p)), 255);
    case 5122:
      return scaled(float(value_at<std::int16_t>(p)), 32767);
    case 5123:
      return scaled(float(value_at<std::uint16_t>(p)), 65535);
    case 5125:
      return scaled(float(value_at<std::uint32_t>(p)), 4294967295.0f);
    default:
      return value_at<float>(p);
  }
}
std::uint32_t whole_at(const std::uint8_t* p, int code) {
  switch (code) {
    case 5121:
      return value_at<std::uint8_t>(p);
    case 5123:
      return value_at<std::uint16_t>(p);
    default:
      return value_at<std::uint32_t>(p);
  }
}

std::optional<ComponentType> component_type(const Element& element) {
  const auto code = element.whole();
  if (!code) return std::nullopt;
  for (const ComponentType& type : component_types)
    if (std::uint64_t(type.code) == *code) return type;
  element.error(std::to_string(*code) + " is not a component type; valid: 5120, 5121, 5122, 5123, 5125, 5126");
  return std::nullopt;
}

// Elements of a view from an offset on.
struct Range {
  const std::uint8_t* first;
  std::size_t stride;
};

// The position of `count` elements of `size` bytes, if all of them are inside the view that `element` names.
std::optional<Range> range_of(Document& document, const Element& element, std::uint64_t count, std::size_t size) {
  const auto number = element.required("bufferView").index_of(document.list("bufferViews"), "a buffer view");
  if (!number) return std::nullopt;
  const auto offset = element["byteOffset"].whole();
  if (element["byteOffset"] && !offset) return std::nullopt;
  const auto view = document.view(*number);
  if (!view) return std::nullopt;
  const std::size_t stride = view->stride == 0 ? size : view->stride;
  const std::uint64_t start = offset.value_or(0), bytes = view->bytes.size();
  if (stride < size) {
    element.error("elements of " + std::to_string(size) + " bytes do not fit the byteStride of " +
                  std::to_string(stride) + " of buffer view " + std::to_string(*number));
    return std::nullopt;
  }
  // No sum overflows: every number is below 2^53.
  const bool fits =
      count == 0 || (start <= bytes && size <= bytes - start && count - 1 <= (bytes - start - size) / stride);
  if (!fits) {
    element.error(std::to_string(count) + " elements reach beyond the end of buffer view " + std::to_string(*number) +
                  ", which has " + std::to_string(bytes) + " bytes");
    return std::nullopt;
  }
  return Range{view->bytes.data() + start, stride};
}

// Replaces the elements that the sparse part states (glTF 2.0, 3.6.2.3). `put(i, p)` stores the element at p.
template <class Put>
bool apply_sparse(Document& document, const Element& sparse, std::uint64_t count, std::size_t size, Put put) {
  const auto replaced = sparse.required("count").whole(count);
  const Element indices = sparse.required("indices"), values = sparse.required("values");
  const auto type = component_type(indices.required("componentType"));
  if (!replaced || !type) return false;
  if (type->code != 5121 && type->code != 5123 && type->code != 5125) {
    indices["componentType"].error("indices are of type 5121, 5123 or 5125");
    return false;
  }
  const auto places = range_of(document, indices, *replaced, type->size);
  const auto elements = range_of(document, values, *replaced, size);
  if (!places || !elements) return false;
  for (std::size_t k = 0; k < *replaced; ++k) {
    const std::uint32_t i = whole_at(places->first + k * places->stride, type->code);
    if (i >= count) {
      indices.error("index " + std::to_string(i) + " is beyond the " + std::to_string(count) + " elements");
      return false;
    }
    put(i, elements->first + k * elements->stride);
  }
  return true;
}

}  // namespace

std::optional<Numbers> read_accessor(Document& document, const Element& user, const AccessorUse& use) {
  constexpr std::uint64_t max_without_bytes = 1 << 24;
  const Element accessors = document.list("accessors");
  const auto number = user.index_of(accessors, "an accessor");
  if (!number) return std::nullopt;
  const Element accessor = accessors[*number];
  const auto count = accessor.required("count").whole();
  const auto type = accessor.required("componentType") ? component_type(accessor["componentType"]) : std::nullopt;
  const auto shape = accessor.required("type").choice({type_names.begin(), type_names.end()});
  const bool normalized = accessor["normalized"].boolean().value_or(false);
  if (!count || !type || !shape) return std::nullopt;
  if (std::find(use.types.begin(), use.types.end(), *shape) == use.types.end()) {
    std::string valid;
    for (std::string_view name : use.types) (valid += valid.empty() ? "" : " or ") += name;
    user.error("accessor " + std::to_string(*number) + " is of type " + *shape + "; " + valid + " is needed here");
    return std::nullopt;
  }
  if (use.integers && type->code != 5121 && type->code != 5123 && type->code != 5125) {
    user.error("accessor " + std::to_string(*number) + " must be of component type 5121, 5123 or 5125");
    return std::nullopt;
  }
  Numbers numbers{std::size_t(*count), components_of(*shape), {}, {}};
  const std::size_t n = numbers.components, size = n * type->size;
  std::optional<Range> range;
  if (accessor["bufferView"]) {
    range = range_of(document, accessor, *count, size);
    if (!range) return std::nullopt;
  } else if (*count > max_without_bytes) {
    accessor.error("has " + std::to_string(*count) + " elements and no buffer view");
    return std::nullopt;
  }
  if (use.integers)
    numbers.all.assign(numbers.count * n, 0);
  else
    numbers.values.assign(numbers.count * n, 0.0f);
  const auto put = [&](std::size_t i, const std::uint8_t* p) {
    for (std::size_t c = 0; c < n; ++c)
      if (use.integers)
        numbers.all[i * n + c] = whole_at(p + c * type->size, type->code);
      else
        numbers.values[i * n + c] = real_at(p + c * type->size, type->code, normalized);
  };
  if (range)
    for (std::size_t i = 0; i < numbers.count; ++i) put(i, range->first + i * range->stride);
  if (const Element sparse = accessor["sparse"]; sparse && !apply_sparse(document, sparse, *count, size, put))
    return std::nullopt;
  if (!std::all_of(numbers.values.begin(), numbers.values.end(), [](float x) { return std::isfinite(x); })) {
    accessor.error("has values that are not finite");
    return std::nullopt;
  }
  return numbers;
}

}  // namespace montelux::gltf
