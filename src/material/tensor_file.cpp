#include "material/tensor_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

namespace montelux {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view signature("tensor_file\0", 12);
// Bytes of an element, by type; zero for a type that does not exist.
constexpr std::array<std::uint64_t, 12> element_bytes{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  std::size_t place() const { return place_; }
  std::optional<std::string_view> text(std::size_t length) {
    if (bytes_.size() - place_ < length) return std::nullopt;
    place_ += length;
    return bytes_.substr(place_ - length, length);
  }
  template <class T>
  std::optional<T> number() {
    const auto raw = text(sizeof(T));
    if (!raw) return std::nullopt;
    T x;
    std::memcpy(&x, raw->data(), sizeof x);
    return x;
  }

 private:
  std::string_view bytes_;
  std::size_t place_ = 0;
};

// Printable characters alone.
std::string shown(std::string_view name) {
  std::string text(name.substr(0, 40));
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

// The product of the sizes; nothing if it exceeds `limit`.
std::optional<std::uint64_t> product(std::uint64_t first, const std::vector<std::uint64_t>& sizes,
                                     std::uint64_t limit) {
  if (std::ranges::find(sizes, std::uint64_t(0)) != sizes.end()) return 0;
  for (std::uint64_t size : sizes) {
    if (size > limit / first) return std::nullopt;
    first *= size;
  }
  return first;
}

}  // namespace

Result<std::vector<TensorField>> read_tensor_file(std::string_view bytes) {
  Reader reader(bytes);
  const auto cut = [&] {
    return Failure{fmt::format("the file ends at byte {}, inside its list of fields", bytes.size())};
  };
  if (reader.text(signature.size()) != signature) return Failure{"it does not begin with \"tensor_file\""};
  const auto major = reader.number<std::uint8_t>(), minor = reader.number<std::uint8_t>();
  if (!minor) return cut();
  if (*major != 1 || *minor != 0) return Failure{fmt::format("its version is {}.{}; 1.0 is read", *major, *minor)};
  const auto count = reader.number<std::uint32_t>();
  if (!count) return cut();

  std::vector<TensorField> fields;
  for (std::uint32_t i = 0; i < *count; ++i) {
    const std::size_t start = reader.place();
    const auto length = reader.number<std::uint16_t>();
    const auto name = length ? reader.text(*length) : std::nullopt;
    const auto dimensions = reader.number<std::uint16_t>();
    const auto type = reader.number<std::uint8_t>();
    const auto offset = reader.number<std::uint64_t>();
    if (!name || !dimensions || !type || !offset) return cut();
    const std::string at = fmt::format("field '{}', stated at byte {},", shown(*name), start);
    if (*type >= element_bytes.size() || element_bytes[*type] == 0)
      return Failure{fmt::format("{} has the unknown type {}", at, *type)};
    std::vector<std::uint64_t> sizes;
    for (std::uint16_t d = 0; d < *dimensions; ++d) {
      const auto size = reader.number<std::uint64_t>();
      if (!size) return cut();
      sizes.push_back(*size);
    }
    const auto length_of_data = product(element_bytes[*type], sizes, bytes.size());
    if (!length_of_data || *offset > bytes.size() || *length_of_data > bytes.size() - *offset)
      return Failure{
          fmt::format("{} goes beyond the end of the file at byte {}: its data begin at byte {}, with {} elements", at,
                      bytes.size(), *offset, fmt::join(sizes, " x "))};
    fields.push_back({std::string(*name), TensorType(*type), std::move(sizes),
                      bytes.substr(std::size_t(*offset), std::size_t(*length_of_data))});
  }
  return fields;
}

}  // namespace montelux
