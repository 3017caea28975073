#include "light/light_set.h"

#include <algorithm>

namespace montelux {

LightSet::LightSet(LightTables tables, LightSettings settings) : tables_(std::move(tables)), settings_(settings) {
  if (tables_.transforms.empty()) tables_.transforms.push_back({});
  for (std::uint32_t i = 0; i < count(); ++i)
    if (is_unbounded(kind(LightId(i)))) unbounded_.push_back(i);
  std::stable_partition(unbounded_.begin(), unbounded_.end(),
                        [&](std::uint32_t i) { return is_infinite(kind(LightId(i))); });
  infinite_count_ = int(std::count_if(unbounded_.begin(), unbounded_.end(),
                                      [&](std::uint32_t i) { return is_infinite(kind(LightId(i))); }));
  if (settings_.selection == LightSelection::power && count() > 0)
    by_power_.emplace(std::vector<double>(tables_.powers.begin(), tables_.powers.end()));
  if (settings_.selection == LightSelection::bvh) bvh_ = LightBvh(tables_.bounds);
  std::size_t shares = unbounded_.size() + (bvh_.empty() ? 0 : 1);
  unbounded_mass_ = shares > 0 ? 1.0f / float(shares) : 0.0f;
}

}  // namespace montelux
