// What a picture lacks of what its scene file names, as results state it.
#pragma once
#include <string_view>

#include "api/scene.h"

namespace montelux::cli {

// What the picture of a scene lacks of what its file names.
struct Shortcomings {
  const std::vector<std::string>& missing;  // light
  const std::vector<Replacement>& replaced;
  const std::vector<std::string>& left_out;
};

// A line for each on standard output, where there are any; the words before them are `width` wide and stand behind
// `indent`.
void print_text(const Shortcomings& s, int width, std::string_view indent = "");

// "missing_light": [...], "replaced": [{"family": "integrator", "name": "sppm", "by": "path"}, ...], "left_out": [...].
template <class Json>
void add_to(Json& json, const Shortcomings& s) {
  json["missing_light"] = s.missing;
  json["replaced"] = Json::array();
  for (const Replacement& r : s.replaced)
    json["replaced"].push_back({{"family", r.family}, {"name", r.name}, {"by", r.by}});
  json["left_out"] = s.left_out;
}

}  // namespace montelux::cli
