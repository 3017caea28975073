#include "filter/table.h"

namespace montelux {

namespace {

using enum ParameterType;

std::vector<ParameterSpec> with_radius(const char* x, const char* y, std::vector<ParameterSpec> list = {}) {
  list.insert(list.begin(), {{"xradius", {number}, x, 1e-3, 64}, {"yradius", {number}, y, 1e-3, 64}});
  return list;
}

}  // namespace

std::span<const EntitySpec> filter_table() {
  static const std::vector<EntitySpec> table{
      {"box", "the mean of the pixel", with_radius("default 0.5", "default 0.5")},
      {"gaussian", "a Gaussian that falls to zero at the radius",
       with_radius("default 1.5", "default 1.5", {{"sigma", {number}, "standard deviation; default 0.5", 1e-3, 1e3}})},
      {"mitchell", "Mitchell and Netravali's cubic",
       with_radius("default 2", "default 2",
                   {{"B", {number}, "default 1/3", -1e3, 1e3}, {"C", {number}, "default 1/3", -1e3, 1e3}})},
      {"sinc", "a Lanczos-windowed sinc",
       with_radius("default 4", "default 4", {{"tau", {number}, "cycles of the window; default 3", 1e-3, 1e3}})},
      {"triangle", "a tent", with_radius("default 2", "default 2")},
  };
  return table;
}

}  // namespace montelux
