#include "parameter/spec.h"

namespace montelux {

const EntitySpec* find_entity(std::span<const EntitySpec> table, std::string_view name) {
  for (const EntitySpec& entity : table)
    if (entity.name == name) return &entity;
  return nullptr;
}
const ParameterSpec* find_parameter(const EntitySpec& entity, std::string_view name) {
  for (const ParameterSpec& parameter : entity.parameters)
    if (parameter.name == name) return &parameter;
  return nullptr;
}
std::vector<std::string_view> names_of(std::span<const EntitySpec> table) {
  std::vector<std::string_view> names;
  for (const EntitySpec& entity : table) names.push_back(entity.name);
  return names;
}
std::string listed(const std::vector<std::string_view>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 < names.size() ? ", " : " and ";
    list += names[i];
  }
  return list;
}

}  // namespace montelux
