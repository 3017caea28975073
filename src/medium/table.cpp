#include "medium/table.h"

#include "medium/build.h"

namespace montelux {

namespace {

using enum ParameterType;

constexpr double most = 1e30;

std::vector<std::string_view> preset_names() {
  std::vector<std::string_view> names;
  for (const MeasuredMedium& medium : measured_media()) names.push_back(medium.name);
  return names;
}

}  // namespace

std::span<const EntitySpec> medium_table() {
  static const std::vector<EntitySpec> table{
      {"homogeneous",
       "the same everywhere",
       {{"preset", {string}, "measured coefficients, per millimetre; default Wholemilk", 0, 0, preset_names()},
        {"sigma_a", {spectrum}, "absorption per unit of length; default the preset's", 0, most},
        {"sigma_s", {spectrum}, "scattering per unit of length; default the preset's", 0, most},
        {"scale", {number}, "factor of both; default 1", 0, most},
        {"g", {number}, "mean cosine of the phase function of Henyey and Greenstein; default 0", -0.999, 0.999},
        {"Le", {spectrum}, "emitted radiance, times sigma_a per unit of length; default 0", 0, most},
        {"Lescale", {number}, "factor of Le; default 1", 0, most}}},
      {"uniformgrid", "densities on a grid", {}, true},
      {"rgbgrid", "coefficients on a grid", {}, true},
      {"cloud", "procedural cloud", {}, true},
      {"nanovdb", "densities of a NanoVDB file", {}, true},
  };
  return table;
}

}  // namespace montelux
