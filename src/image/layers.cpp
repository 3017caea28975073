#include "image/layers.h"

namespace montelux {

std::vector<std::string> layer_names(const LayerPlan& plan) {
  std::vector<std::string> names;
  if (plan.bounces) {
    for (int i = 0; i <= *plan.bounces; ++i) names.push_back("bounce" + std::to_string(i));
    names.push_back("bounce_rest");
  }
  if (plan.light_groups)
    for (const std::string& group : plan.group_names) names.push_back("Combined_" + group);
  if (plan.techniques)
    for (std::string_view technique : technique_names) names.push_back("technique_" + std::string(technique));
  return names;
}

std::vector<LayerFamily> layer_families(const LayerPlan& plan) {
  std::vector<LayerFamily> families;
  int first = 0;
  const auto add = [&](const char* name, int count) {
    if (count > 0) families.push_back({name, first, count});
    first += count;
  };
  add("bounces", plan.bounce_count());
  add("light groups", plan.group_count());
  add("techniques", plan.techniques ? int(technique_names.size()) : 0);
  return families;
}

}  // namespace montelux
