// What Montelux knows by name: the same tables that the reader of scenes uses, for people.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace montelux {

struct CatalogueParameter {
  std::string name, types;  // types as a scene file spells them: "float", "spectrum|texture"
  std::string meaning;
  bool later = false;  // known, not applied yet
};

struct CatalogueEntry {
  std::string name, meaning;
  std::vector<CatalogueParameter> parameters;
  bool later = false;   // known, cannot be done yet
  std::string instead;  // what serves for it; may be empty
};

// "integrators", "samplers", "materials", ..., each with a line on what it is.
std::vector<std::pair<std::string, std::string>> catalogue_topics();

// The names of one topic; nothing for an unknown topic.
std::optional<std::vector<CatalogueEntry>> catalogue(std::string_view topic);

}  // namespace montelux
