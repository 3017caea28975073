#include "lab/expression/text_part.h"

namespace montelux::lab {

TextPart trimmed(TextPart part) {
  while (!part.text.empty() && part.text.front() == ' ') part.text.remove_prefix(1), ++part.begin;
  while (!part.text.empty() && part.text.back() == ' ') part.text.remove_suffix(1);
  return part;
}

std::vector<TextPart> split(TextPart whole, char at, std::size_t max_parts) {
  std::vector<TextPart> parts;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t i = 0; i < whole.text.size(); ++i) {
    const char c = whole.text[i];
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c != at || depth > 0 || parts.size() + 1 >= max_parts) continue;
    parts.push_back({whole.text.substr(begin, i - begin), whole.begin + begin});
    begin = i + 1;
  }
  parts.push_back({whole.text.substr(begin), whole.begin + begin});
  return parts;
}

}  // namespace montelux::lab
