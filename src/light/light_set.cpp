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
  for (std::uint32_t i = 0; i < count(); ++i) {
    has_delta_ |= is_delta(kind(LightId(i))), has_points_ |= is_at_point(kind(LightId(i)));
    has_masked_ |= rows<float>(i, true).flag(light_masked);
  }
  if (settings_.selection == LightSelection::power && count() > 0) power_table_ = by_power();
  if (settings_.selection == LightSelection::bvh) bvh_ = LightBvh(tables_.bounds);
  std::size_t shares = unbounded_.size() + (bvh_.empty() ? 0 : 1);
  equal_mass_ = shares > 0 ? 1.0f / float(shares) : 0.0f;
  // Powers are those through the disk of the scene; of a light from all directions a plane receives a quarter.
  const float disk = pi * tables_.scene_radius * tables_.scene_radius;
  for (const std::uint32_t i : unbounded_)
    unbounded_irradiance_ += tables_.powers[i] / disk * (is_infinite(kind(LightId(i))) ? 0.25f : 1.0f);
}

AliasTable LightSet::by_power() const {
  return AliasTable(std::vector<double>(tables_.powers.begin(), tables_.powers.end()));
}

std::optional<LightPolygon> LightSet::polygon(LightId light) const {
  const LightKind its_kind = kind(light);
  if (its_kind != LightKind::triangle && its_kind != LightKind::parallelogram) return std::nullopt;
  const LightRows<float> row = rows<float>(std::uint32_t(light), true);
  // The rows of both kinds begin with a corner and two edges.
  const TriangleEmitter<float> flat(row);
  const Vec3f a = flat.p0, b = a + flat.e1, d = a + flat.e2;
  if (its_kind == LightKind::triangle) return LightPolygon{{a, b, d, d}, 3};
  return LightPolygon{{a, b, b + flat.e2, d}, 4};
}

}  // namespace montelux
