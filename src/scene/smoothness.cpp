#include "scene/smoothness.h"

#include <algorithm>
#include <cmath>

namespace montelux {

namespace {

bool is_smooth(const Material& material) {
  if (material.is_interface || material.mixture) return false;
  // Facets of these slots; `power` converts their values to GGX's alpha.
  const auto are_smooth = [&](int x, int y, float power) {
    for (const RowBinding& binding : material.bindings)
      if (binding.slot == x || binding.slot == y) return true;
    const float* v = material.row.v;
    return GgxFacets<float>(std::pow(v[x], power), std::pow(v[y], power)).is_smooth();
  };
  switch (material.kind) {
    case BsdfKind::conductor:
      return are_smooth(ConductorSlots::alpha_x, ConductorSlots::alpha_y, 1);
    case BsdfKind::dielectric:
    case BsdfKind::tinted_dielectric:
      return material.row.v[DielectricSlots::eta] == 1 ||
             are_smooth(DielectricSlots::alpha_x, DielectricSlots::alpha_y, 1);
    case BsdfKind::coated_diffuse:
    case BsdfKind::coated_conductor:
      return are_smooth(LayeredSlots::alpha_x, LayeredSlots::alpha_y, 1);
    case BsdfKind::metallic_roughness:
      return are_smooth(MetallicRoughnessSlots::roughness, MetallicRoughnessSlots::roughness, 2);
    case BsdfKind::coated_metallic_roughness:
      return are_smooth(MetallicRoughnessSlots::roughness, MetallicRoughnessSlots::roughness, 2) ||
             are_smooth(CoatedMetallicRoughnessSlots::coat_roughness, CoatedMetallicRoughnessSlots::coat_roughness, 2);
    case BsdfKind::thin_dielectric:
      return are_smooth(ThinDielectricSlots::alpha, ThinDielectricSlots::alpha, 1);
    case BsdfKind::diffuse:
    case BsdfKind::diffuse_transmission:
    case BsdfKind::phong:
    case BsdfKind::measured:
      break;
  }
  return false;
}

bool is_partly_smooth(const Material& material) {
  if (!is_smooth(material)) return false;
  if (material.kind == BsdfKind::conductor || material.kind == BsdfKind::dielectric ||
      material.kind == BsdfKind::tinted_dielectric || material.kind == BsdfKind::thin_dielectric)
    return false;
  return !material.bindings.empty() || !is_delta<float>({std::uint32_t(material.kind), &material.row, true});
}

bool is_smooth_but_not_plain(const Material& material) {
  if (!is_smooth(material)) return false;
  if (material.has_any_normal_map()) return true;
  switch (material.kind) {
    case BsdfKind::conductor:
    case BsdfKind::thin_dielectric:
      return false;
    case BsdfKind::dielectric:
    case BsdfKind::tinted_dielectric:
      return std::ranges::any_of(material.bindings,
                                 [](const RowBinding& binding) { return binding.slot == DielectricSlots::eta; });
    default:
      return true;
  }
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

}  // namespace montelux
