#include "api/catalogue.h"

#include <fmt/format.h>

#include "api/denoisers.h"
#include "api/images.h"
#include "api/render.h"
#include "camera/table.h"
#include "filter/table.h"
#include "integrator/catalogue.h"
#include "io/pbrt/parameters.h"
#include "io/pbrt/picture_models.h"
#include "lab/domain/domain.h"
#include "lab/expression/table.h"
#include "lab/integral/methods.h"
#include "light/table.h"
#include "material/table.h"
#include "medium/table.h"
#include "scene/shape_models.h"
#include "texture/table.h"

namespace montelux {

namespace {

using Names = std::vector<std::pair<std::string, std::string>>;

CatalogueEntry entry_of(const EntitySpec& spec) {
  CatalogueEntry entry{std::string(spec.name), std::string(spec.meaning), {}, spec.later, std::string(spec.instead)};
  for (const ParameterSpec& p : spec.parameters) {
    std::string types;
    for (ParameterType type : p.types) {
      types += types.empty() ? "" : "|";
      types += type == ParameterType::spectrum ? "rgb|spectrum|blackbody" : pbrt::spelling(type);
    }
    std::string meaning(p.meaning);
    if (!p.choices.empty()) meaning += fmt::format(" ({})", fmt::join(p.choices, ", "));
    entry.parameters.push_back({std::string(p.name), types, meaning, p.later});
  }
  return entry;
}

std::vector<CatalogueEntry> entries_of(std::span<const EntitySpec> table) {
  std::vector<CatalogueEntry> entries;
  for (const EntitySpec& spec : table) entries.push_back(entry_of(spec));
  return entries;
}

std::vector<CatalogueEntry> entries_of(const Names& names) {
  std::vector<CatalogueEntry> entries;
  for (const auto& [name, meaning] : names) entries.push_back({name, meaning, {}, false, {}});
  return entries;
}

// Functions and constants of expressions.
std::vector<CatalogueEntry> expression_names() {
  Names names;
  for (const lab::NamedFunction& f : lab::expression_functions()) names.emplace_back(f.name, f.meaning);
  for (const lab::NamedConstant& c : lab::expression_constants()) names.emplace_back(c.name, c.meaning);
  return entries_of(names);
}

struct Topic {
  std::string_view name, meaning;
  std::vector<CatalogueEntry> (*entries)();
};

constexpr Topic topics[] = {
    {"integrators", "algorithms for --integrator", [] { return entries_of(integrator_catalogue()); }},
    {"presets", "integrators with samples, for --preset", [] { return entries_of(preset_names()); }},
    {"denoisers", "filters that remove noise, for --denoiser", [] { return entries_of(denoiser_table()); }},
    {"samplers", "point sets for --sampler", [] { return entries_of(sampler_names()); }},
    {"tones", "tone curves for --tone", [] { return entries_of(tone_curves()); }},
    {"methods", "methods of integration for integrate --method", [] { return entries_of(lab::method_table()); }},
    {"domains", "domains for integrate --over besides intervals", [] { return entries_of(lab::domain_table()); }},
    {"functions", "functions and constants of expressions", [] { return expression_names(); }},
    {"materials", "materials of a scene", [] { return entries_of(material_models().specs()); }},
    {"textures", "textures of a scene", [] { return entries_of(texture_models().specs()); }},
    {"lights", "lights of a scene that are not shapes", [] { return entries_of(light_models().specs()); }},
    {"area-lights", "emission of the surface of a shape", [] { return entries_of(area_light_models().specs()); }},
    {"shapes", "shapes of a scene", [] { return entries_of(shape_models().specs()); }},
    {"cameras", "cameras of a scene", [] { return entries_of(camera_models().specs()); }},
    {"films", "films of a scene", [] { return entries_of(pbrt::film_models().specs()); }},
    {"filters", "pixel filters of a scene", [] { return entries_of(filter_models().specs()); }},
    {"media", "participating media of a scene", [] { return entries_of(medium_models().specs()); }},
    {"scene-integrators", "integrators that a scene can state",
     [] { return entries_of(pbrt::integrator_models().specs()); }},
    {"scene-samplers", "samplers that a scene can state", [] { return entries_of(pbrt::sampler_models().specs()); }},
    {"options", "options of a scene", [] { return std::vector{entry_of(pbrt::option_models().specs()[0])}; }},
};

}  // namespace

Names catalogue_topics() {
  Names names;
  for (const Topic& topic : topics) names.emplace_back(topic.name, topic.meaning);
  return names;
}

std::optional<std::vector<CatalogueEntry>> catalogue(std::string_view name) {
  for (const Topic& topic : topics)
    if (topic.name == name) return topic.entries();
  return std::nullopt;
}

}  // namespace montelux
