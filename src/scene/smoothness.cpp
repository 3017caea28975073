#include "scene/smoothness.h"

#include <algorithm>
#include <cmath>

#include "material/specular_lobe.h"

namespace montelux {

namespace {

// With the constants of its row.
bool consists_of_deltas(const Material& material) {
  return is_delta<float>({std::uint32_t(material.kind), &material.row, true});
}

// Whether a texture decides the slot.
bool is_bound(const Material& material, int slot) {
  return std::ranges::any_of(material.bindings, [&](const RowBinding& binding) { return binding.slot == slot; });
}

bool is_smooth(const Material& material) {
  if (material.is_interface || material.mixture) return false;
  const float* v = material.row.v;
  const auto may_be = [&](const FacetSlots& facets) {
    if (facets.is_covered) return false;
    if (is_bound(material, facets.u) || is_bound(material, facets.v)) return true;
    return GgxFacets<float>(std::pow(v[facets.u], facets.power), std::pow(v[facets.v], facets.power)).is_smooth();
  };
  bool result = consists_of_deltas(material);
  for_each_present_model<float>(std::uint32_t(material.kind), true, [&]<class Model>(bool) {
    result = result || std::ranges::any_of(Model::facet_slots, may_be);
  });
  return result;
}

bool is_partly_smooth(const Material& material) {
  if (!is_smooth(material) || has_specular_lobe(material.kind)) return false;
  return !material.bindings.empty() || !consists_of_deltas(material);
}

bool is_smooth_but_not_plain(const Material& material) {
  return is_smooth(material) && (material.has_any_normal_map() || !has_specular_lobe(material.kind));
}

// Whether the condition holds for the material, or for a part of a mixture.
bool any_part(const MaterialSet& materials, std::size_t number, bool (&condition)(const Material&)) {
  const Material& material = materials[number];
  if (!material.mixture) return condition(material);
  const auto& parts = material.mixture->children;
  return std::any_of(parts.begin(), parts.end(),
                     [&](std::uint32_t part) { return any_part(materials, part, condition); });
}

}  // namespace

bool may_be_smooth(const MaterialSet& materials, std::size_t number) { return any_part(materials, number, is_smooth); }
bool may_be_partly_smooth(const MaterialSet& materials, std::size_t number) {
  return any_part(materials, number, is_partly_smooth);
}

bool is_plain_specular(const MaterialSet& materials, std::size_t number) {
  return may_be_smooth(materials, number) && !any_part(materials, number, is_smooth_but_not_plain);
}

bool is_plain_rough(const MaterialSet& materials, std::size_t number, float max_roughness) {
  const Material& material = materials[number];
  if (material.is_interface || material.mixture || material.has_any_normal_map()) return false;
  if (!has_specular_facets(material.kind) || is_smooth(material)) return false;
  bool has_texture = false;
  for_each_present_model<float>(std::uint32_t(material.kind), true, [&]<class Model>(bool) {
    for (const FacetSlots& facets : Model::facet_slots)
      has_texture = has_texture || is_bound(material, facets.u) || is_bound(material, facets.v);
  });
  const Roughness<float> roughness = specular_facets(material.kind, material.row);
  return !has_texture && roughness.x == roughness.y && roughness.x <= max_roughness;
}

}  // namespace montelux
