#include "shortcomings.h"

#include <fmt/format.h>

namespace montelux::cli {

void print_text(const Shortcomings& s, int width, std::string_view indent) {
  const auto print = [&](std::string_view word, const std::string& text) {
    fmt::print("{}{:{}}{}\n", indent, word, width, text);
  };
  for (const std::string& light : s.missing) print("missing", light);
  for (const Replacement& r : s.replaced) print("replaced", to_text(r));
  for (const std::string& omission : s.left_out) print("left out", omission);
}

}  // namespace montelux::cli
