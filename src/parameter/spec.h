// Tables of what may be stated: each family (materials, lights, ...) has one, which the parser, the writer, the
// documentation and the bindings use.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "parameter/value.h"

namespace montelux {

// One parameter that an entity takes. `types` lists all types in which it may be given.
struct ParameterSpec {
  std::string_view name;
  std::vector<ParameterType> types;
  std::string meaning;                      // one line: meaning, unit, default
  double low = -1e30, high = 1e30;          // valid range of numbers and integers, inclusive
  std::vector<std::string_view> choices{};  // valid strings; empty: any
  bool array = false;                       // takes more than one value
  bool later = false;                       // known but not applied yet: a reader warns about it
  std::string_view formerly{};              // an earlier name, which settings still accept; empty: none
};

// One name of a family. `later`: Montelux knows the name but does not support it yet.
struct EntitySpec {
  std::string_view name;
  std::string_view meaning;  // one line
  std::vector<ParameterSpec> parameters;
  bool later = false;
  std::string_view instead{};  // the closest substitute, if there is a sensible one (cameras, samplers, ...)
  bool same = false;           // the substitute is equivalent: no note is needed
};

// Null if the table does not have the name.
const EntitySpec* find_entity(std::span<const EntitySpec> table, std::string_view name);
const ParameterSpec* find_parameter(const EntitySpec& entity, std::string_view name);
std::vector<std::string_view> names_of(std::span<const EntitySpec> table);
// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string_view>& names);

}  // namespace montelux
