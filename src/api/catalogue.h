// Everything that Montelux knows by name: the tables of the scene reader, in a form for users.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace montelux {

struct CatalogueParameter {
  std::string name, types;  // types in the notation of scene files: "float", "spectrum|texture"
  std::string meaning;
  bool later = false;  // known, but not applied yet
};

struct CatalogueEntry {
  std::string name, meaning;
  std::vector<CatalogueParameter> parameters;
  bool later = false;   // known, but not supported yet
  std::string instead;  // the substitute; may be empty
};

// "integrators", "samplers", "materials", ..., each with a one-line description.
std::vector<std::pair<std::string, std::string>> catalogue_topics();

// The names of one topic; nothing for an unknown topic.
std::optional<std::vector<CatalogueEntry>> catalogue(std::string_view topic);

}  // namespace montelux
