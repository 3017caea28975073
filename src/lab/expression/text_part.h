// Splitting a text of the user while keeping the position of each part.
#pragma once
#include <string_view>
#include <vector>

namespace montelux::lab {

// A part of a text, and its position there in bytes.
struct TextPart {
  std::string_view text;
  std::size_t begin = 0;
};

// Without white space at its ends.
TextPart trimmed(TextPart part);
// Splits at a character, but not within brackets; into at most `most` parts.
std::vector<TextPart> split(TextPart whole, char at, std::size_t max_parts = std::string_view::npos);

}  // namespace montelux::lab
