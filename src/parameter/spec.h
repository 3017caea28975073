// Tables of what may be stated: each family of things (materials, lights, ...) has one, and the parser, the writer, the
// documentation and the bindings read it.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "parameter/value.h"

namespace montelux {

// One parameter that an entity takes. `types` lists all types in which it may be given.
struct ParameterSpec {
  std::string_view name;
  std::vector<ParameterType> types;
  std::string_view meaning;                 // one line: meaning, unit, default
  double low = -1e30, high = 1e30;          // valid range of numbers and integers, inclusive
  std::vector<std::string_view> choices{};  // valid strings; empty: any
  bool array = false;                       // more than one value is meant
  bool later = false;                       // known and not applied yet: a reader warns where it is given
};

// One name of a family. `later` says that Montelux knows the name and cannot do it yet.
struct EntitySpec {
  std::string_view name;
  std::string_view meaning;  // one line
  std::vector<ParameterSpec> parameters;
  bool later = false;
  std::string_view instead{};  // the nearest that Montelux has, where a stand-in is sensible (cameras, samplers, ...)
  bool same = false;           // what serves instead does the same: nobody need be told
};

// Null where the table has no such name.
const EntitySpec* find_entity(std::span<const EntitySpec> table, std::string_view name);
const ParameterSpec* find_parameter(const EntitySpec& entity, std::string_view name);
std::vector<std::string_view> names_of(std::span<const EntitySpec> table);

}  // namespace montelux
