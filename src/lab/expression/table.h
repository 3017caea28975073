// The names available in an expression: constants, and functions with one or more arguments.
#pragma once
#include <cstddef>
#include <span>
#include <string_view>

namespace montelux::lab {

struct NamedConstant {
  std::string_view name;
  double value;
  std::string_view meaning;
};

// A function for one point and for many. `arguments` is 1, 2 or 3, or 0 for any number (at least one).
struct NamedFunction {
  std::string_view name;
  int arguments;
  std::string_view meaning;
  double (*one)(double) = nullptr;
  double (*two)(double, double) = nullptr;
  double (*three)(double, double, double) = nullptr;
  double (*any)(const double*, int) = nullptr;
  // Sets out[i] to the function of arguments[0][i], arguments[1][i], ...; out may be one of the arguments.
  void (*batch)(std::span<const double* const> arguments, std::size_t count, double* out) = nullptr;
};

std::span<const NamedConstant> expression_constants();
std::span<const NamedFunction> expression_functions();

}  // namespace montelux::lab
