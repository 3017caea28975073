// The names that options take, with their meanings.
#include "api/render.h"
#include "integrator/catalogue.h"
#include "integrator/direct/settings.h"
#include "parameter/choice.h"

namespace montelux {

Status check_integrator_text(const std::string& text) {
  auto choice = parse_choice(text);
  if (!choice) return choice.failure();
  return check_integrator(*choice);
}

std::vector<std::pair<std::string, std::string>> integrator_names() {
  std::vector<std::pair<std::string, std::string>> names;
  for (const EntitySpec& spec : integrator_catalogue()) names.emplace_back(spec.name, spec.meaning);
  return names;
}

std::vector<std::pair<std::string, std::string>> sampler_names() {
  std::vector<std::pair<std::string, std::string>> names;
  for (const NamedPointSet& set : point_set_names) names.emplace_back(set.name, set.description);
  for (const NamedPointSet& set : fixed_point_set_names) names.emplace_back(set.name, set.description);
  return names;
}

std::vector<std::pair<std::string, std::string>> preset_names() {
  std::vector<std::pair<std::string, std::string>> names;
  for (const DirectPreset& preset : direct_presets()) names.emplace_back(preset.name, preset.meaning);
  return names;
}

std::string version() { return MONTELUX_VERSION; }

}  // namespace montelux
