#include "shortcomings.h"

#include <fmt/format.h>

namespace montelux::cli {

void print_text(const Shortcomings& s, int width) {
  for (const std::string& light : s.missing) fmt::print("{:{}}{}\n", "missing", width, light);
  for (const Replacement& r : s.replaced) fmt::print("{:{}}{}\n", "replaced", width, to_text(r));
  for (const std::string& omission : s.left_out) fmt::print("{:{}}{}\n", "left out", width, omission);
}

}  // namespace montelux::cli
