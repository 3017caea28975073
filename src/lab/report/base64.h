// Bytes as text of 64 letters (RFC 4648, section 4).
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

namespace montelux::lab {

inline constexpr std::string_view base64_letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

inline std::string base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < here ? (unsigned char)bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= here ? base64_letters[group >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

// The bytes that base64() made such text of; nothing where it did not.
inline std::optional<std::string> bytes_of_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  unsigned char values[256];
  std::fill(std::begin(values), std::end(values), 64);
  for (std::size_t i = 0; i < 64; ++i) values[(unsigned char)base64_letters[i]] = (unsigned char)i;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t i = 0; i < text.size(); i += 4) {
    unsigned group = 0;
    std::size_t filled = 0;
    for (; filled < 4 && text[i + filled] != '='; ++filled) {
      const unsigned value = values[(unsigned char)text[i + filled]];
      if (value == 64) return std::nullopt;
      group |= value << (18 - 6 * filled);
    }
    const bool last = i + 4 == text.size();
    if (filled < 2 || (filled < 4 && !last) || (filled == 2 && text[i + 3] != '=')) return std::nullopt;
    for (std::size_t k = 0; k + 1 < filled; ++k) bytes += char(group >> (16 - 8 * k) & 255u);
  }
  return bytes;
}

}  // namespace montelux::lab
