// A checksum of text, against accidental changes. Internal to the facade.
#pragma once
#include <cstdint>
#include <string_view>

namespace montelux {

// FNV-1a with 64 bits (Fowler, Noll and Vo 1991) of the text, optionally continuing that of another text.
inline std::uint64_t checksum(std::string_view text, std::uint64_t before = 0xcbf29ce484222325u) {
  for (char c : text) before = (before ^ std::uint8_t(c)) * 0x100000001b3u;
  return before;
}

}  // namespace montelux
