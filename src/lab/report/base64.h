// Bytes as text of 64 letters (RFC 4648, section 4).
#pragma once
#include <algorithm>
#include <string>
#include <string_view>

namespace montelux::lab {

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < here ? (unsigned char)bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= here ? letters[group >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

}  // namespace montelux::lab
