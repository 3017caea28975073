#include "lab/domain/domain.h"

namespace montelux::lab {

std::span<const EntitySpec> domain_table() {
  using enum ParameterType;
  static const std::vector<EntitySpec> entries{
      {"disk", "the disk about the origin; variables x, y, r, phi; area", {{"radius", {number}, "default 1"}}},
      {"triangle",
       "a triangle of the plane or of space; variables x, y and, in space, z; area",
       {{"a", {point3}, "corner (x, y) or (x, y, z); default (0, 0)"},
        {"b", {point3}, "corner; default (1, 0)"},
        {"c", {point3}, "corner; default (0, 1)"}}},
      {"sphere",
       "the unit sphere of directions; variables x, y, z, theta (from z), phi; solid angle",
       {{"radius", {number}, "default 1; with another radius the measure is area"}}},
      {"hemisphere",
       "directions with z >= 0; variables x, y, z, theta (from z), phi",
       {{"measure", {string}, "default solid-angle", -1e30, 1e30, {"solid-angle", "projected"}}}},
      {"ball", "the ball about the origin; variables x, y, z, r; volume", {{"radius", {number}, "default 1"}}},
      {"simplex",
       "x, y, ... >= 0 with a sum up to 1; variables x, y, z, above three dimensions x1, x2, ...; volume",
       {{"dimension", {integer}, "default 2", 1, double(max_dimensions)}}},
      {"cube",
       "the unit cube; variables x1, x2, ...; volume",
       {{"dimension", {integer}, "default 3", 1, double(max_dimensions)}}},
  };
  return entries;
}

}  // namespace montelux::lab
