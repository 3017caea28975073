#include "image/png_check.h"

#include <array>
#include <cstdint>
#include <string>

namespace montelux {

namespace {

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t x = byte;
    for (int bit = 0; bit < 8; ++bit) x = (x & 1u) != 0 ? 0xedb88320u ^ (x >> 1) : x >> 1;
    table[byte] = x;
  }
  return table;
}

std::uint32_t crc(std::string_view bytes) {
  static constexpr std::array<std::uint32_t, 256> table = crc_table();
  std::uint32_t x = ~0u;
  for (const char c : bytes) x = table[(x ^ std::uint8_t(c)) & 0xffu] ^ (x >> 8);
  return ~x;
}

// Big-endian.
std::uint32_t word(std::string_view bytes) {
  std::uint32_t x = 0;
  for (std::size_t i = 0; i < 4; ++i) x = x << 8 | std::uint8_t(bytes[i]);
  return x;
}

}  // namespace

Status check_png(std::string_view bytes) {
  using namespace std::string_view_literals;
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n"sv;
  constexpr std::size_t frame = 12;  // length, name and checksum of a chunk
  if (!bytes.starts_with(signature)) return Done{};
  for (std::string_view rest = bytes.substr(signature.size()); !rest.empty();) {
    if (rest.size() < frame || rest.size() - frame < word(rest)) break;
    const std::size_t length = word(rest);
    const std::string_view chunk = rest.substr(4, 4 + length), name = chunk.substr(0, 4);
    if (crc(chunk) != word(rest.substr(8 + length))) return Failure{"it is damaged: a checksum does not fit its bytes"};
    if (name == "IEND") return Done{};
    rest.remove_prefix(frame + length);
  }
  return Failure{"it is truncated"};
}

}  // namespace montelux
