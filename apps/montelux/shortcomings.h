// What an image lacks in comparison with its scene file, as stated in results.
#pragma once
#include <string_view>

#include "api/scene.h"

namespace montelux::cli {

// What the image of a scene lacks in comparison with its file.
struct Shortcomings {
  const std::vector<std::string>& missing;  // light
  const std::vector<Replacement>& replaced;
  const std::vector<std::string>& left_out;
};

// Prints one line for each entry on standard output, if there are any; the leading words are `width` wide and follow
// `indent`.
void print_text(const Shortcomings& s, int width, std::string_view indent = "");

// "missing_light": [...], "replaced": [{"family": "integrator", "name": "bdpt", "by": "path"}, ...], "left_out": [...].
template <class Json>
void add_to(Json& json, const Shortcomings& s) {
  json["missing_light"] = s.missing;
  json["replaced"] = Json::array();
  for (const Replacement& r : s.replaced)
    json["replaced"].push_back({{"family", r.family}, {"name", r.name}, {"by", r.by}});
  json["left_out"] = s.left_out;
}

}  // namespace montelux::cli
