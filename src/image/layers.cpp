#include "image/layers.h"

#include <utility>

namespace montelux {

namespace {

// "s1_t2": vertices from the light and from the eye, in the order of LayerPlan::strategy_number().
std::vector<std::string> strategy_names(const LayerPlan& plan, bool merged) {
  std::vector<std::string> names;
  if (merged && !plan.mergings) return names;
  for (int bounce = merged ? 1 : 0; bounce <= *plan.strategies; ++bounce) {
    const int all = bounce + (merged ? 3 : 2);  // a vertex that is merged is drawn from both sides
    for (int s = merged ? 2 : 0; s <= bounce + 1; ++s) {
      std::string& name = names.emplace_back("s");
      name += std::to_string(s), name += "_t", name += std::to_string(all - s);
    }
  }
  return names;
}

}  // namespace

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
  if (!plan.strategies) return names;
  const std::vector<std::string> connections = strategy_names(plan, false), mergings = strategy_names(plan, true);
  const auto add = [&](const std::string& prefix, const std::vector<std::string>& strategies) {
    for (const std::string& strategy : strategies) names.push_back(prefix + strategy);
  };
  add("strategy_", connections), add("merging_", mergings);
  names.emplace_back("strategy_rest");
  if (plan.alone) add("alone_", connections), add("alone_merging_", mergings);
  return names;
}

std::optional<std::string_view> layer_family(std::string_view layer_name) {
  using Family = std::pair<std::string_view, std::string_view>;
  for (const auto& [start, family] :
       {Family{"bounce", "bounces"}, Family{"Combined_", "light groups"}, Family{"technique_", "techniques"},
        Family{"strategy_", "strategies"}, Family{"merging_", "strategies"}, Family{"alone_", ""}})
    if (layer_name.starts_with(start)) return family;
  return std::nullopt;
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
  add("techniques", plan.technique_count());
  add("strategies", plan.strategy_count());
  return families;
}

}  // namespace montelux
