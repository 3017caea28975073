#include "integrator/catalogue.h"

#include <fmt/format.h>

#include "integrator/automatic/entry.h"
#include "integrator/bidirectional/entry.h"
#include "integrator/clamped.h"
#include "integrator/direct/entry.h"
#include "integrator/distribution/entry.h"
#include "integrator/irradiance_cache/entry.h"
#include "integrator/light_paths/light_media.h"
#include "integrator/light_tracing/entry.h"
#include "integrator/look/entry.h"
#include "integrator/metropolis/entry.h"
#include "integrator/missing_light.h"
#include "integrator/path/entry.h"
#include "integrator/path/settings.h"
#include "integrator/photons/entry.h"
#include "integrator/radiosity/entry.h"
#include "integrator/restir/entry.h"
#include "integrator/tracepath/entry.h"

namespace montelux {

namespace {

// The one table of integrators.
const std::vector<IntegratorEntry>& entries() {
  static const std::vector<IntegratorEntry> table = [] {
    std::vector<IntegratorEntry> all{
        path_entry(),       naive_entry(),     direct_entry(),    distribution_entry(),     tracepath_entry(),
        restir_di_entry(),  restir_gi_entry(), restir_pt_entry(), radiosity_entry(),        light_tracing_entry(),
        sppm_entry(),       photonmap_entry(), bdpt_entry(),      irradiance_cache_entry(), vcm_entry(),
        metropolis_entry(), automatic_entry()};
    for (IntegratorEntry& look : look_entries()) all.push_back(std::move(look));
    for (IntegratorEntry& entry : all)
      entry.spec.parameters.push_back({"maxcomponent",
                                       {ParameterType::number},
                                       "brighter samples are scaled down to it: biased; default none",
                                       1e-30,
                                       1e30,
                                       {"none"}});
    return all;
  }();
  return table;
}

// A setting that the scene states too: what was typed wins, and "none" lifts it.
template <class T>
std::optional<T> stated(const ChoiceText& choice, std::string_view name, std::optional<T> typed,
                        std::optional<T> by_scene) {
  for (const auto& [key, value] : choice.settings)
    if (key == name) return typed;
  return by_scene;
}

// The entry of the table that is meant, and its settings.
Result<std::pair<const IntegratorEntry*, ParameterList>> read_choice(const ChoiceText& choice) {
  for (const IntegratorEntry& entry : entries()) {
    if (entry.spec.name != choice.name) continue;
    auto list = read_settings(entry.spec, choice.settings, "integrator");
    if (!list) return list.failure();
    return std::pair{&entry, *std::move(list)};
  }
  return unknown_name("integrator", choice.name, names_of(integrator_catalogue()));
}

}  // namespace

ChoiceText with_present_names(ChoiceText choice) {
  if (const EntitySpec* spec = find_entity(integrator_catalogue(), choice.name))
    choice.settings = with_present_names(*spec, std::move(choice.settings));
  return choice;
}

Status check_integrator(const ChoiceText& choice) {
  auto read = read_choice(choice);
  if (!read) return read.failure();
  return Done{};
}

std::span<const EntitySpec> integrator_catalogue() {
  static const std::vector<EntitySpec> specs = [] {
    std::vector<EntitySpec> all;
    for (const IntegratorEntry& entry : entries()) all.push_back(entry.spec);
    return all;
  }();
  return specs;
}

std::vector<std::string_view> integrators_with(Ability ability) {
  std::vector<std::string_view> names;
  for (const IntegratorEntry& entry : entries())
    if (entry.can(ability)) names.push_back(entry.spec.name);
  return names;
}

void note_sampler(ChosenIntegrator& chosen, PointSetKind kind) {
  if (!is_fixed(kind)) return;
  chosen.biases.push_back(fmt::format("sampler={}", name_of(kind)));
  chosen.notes.push_back(
      fmt::format("sampler {} uses the same points in every pixel and every pass: the picture is biased, and nothing "
                  "states its error",
                  name_of(kind)));
}

LightSearch light_search(std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  for (const IntegratorEntry& entry : entries())
    if (entry.spec.name == name) {
      const auto choice = parse_choice(text);
      if (!choice) return entry.search;
      const auto read = read_choice(*choice);
      return read ? entry.search_of(read->second) : entry.search;
    }
  return LightSearch::none;
}

int stated_chain_length(std::string_view text) {
  const auto choice = parse_choice(text);
  if (!choice || choice->name != "path") return 0;
  const auto read = read_choice(*choice);
  if (!read) return 0;
  const auto settings = path_settings(read->second, 1);
  return settings ? settings->manifold : 0;
}

void note_missing_light(ChosenIntegrator& chosen, const IntegratorDefaults& defaults, const Scene& scene,
                        const Accel& accel) {
  for (MissingLight& light :
       missing_light(chosen.search, scene, accel, defaults.width, defaults.height, chosen.chain_length)) {
    chosen.missing.push_back(std::move(light.name));
    chosen.notes.push_back(std::move(light.sentence));
  }
  if (shines_through_endless_medium(scene, accel))
    chosen.notes.push_back(
        "light from infinity comes through a medium that has no boundary: integrators differ in how much of it "
        "arrives; "
        "a closed surface of the material interface around the scene, with that medium inside, defines it");
}

Result<ChosenIntegrator> choose_integrator(const ChoiceText& choice, const IntegratorDefaults& defaults,
                                           const Scene& scene, const Accel& accel) {
  auto read = read_choice(choice);
  if (!read) return read.failure();
  const auto& [entry, list] = *read;

  const bool crosses = scene.media.empty() || entry->can(Ability::media) ||
                       (entry->can(Ability::absorption) && !scene.has_participating_media());
  if (!crosses)
    return Failure{fmt::format("the scene has participating media, which {} cannot cross; {} can", entry->spec.name,
                               listed(integrators_with(Ability::media)))};

  const auto typed_depth = list.find("maxdepth") ? std::optional(list.integer("maxdepth", 0)) : std::nullopt;
  const auto typed_limit = list.find("maxcomponent") ? std::optional(list.number("maxcomponent", 0)) : std::nullopt;
  const auto limit = stated(choice, "maxcomponent", typed_limit, defaults.max_component);
  const IntegratorRequest request{list, stated(choice, "maxdepth", typed_depth, defaults.max_depth), defaults, scene,
                                  accel};
  Result<ChosenIntegrator> result = entry->make(request);
  if (!result) return result;
  // A row that no reader knows would be ignored in silence.
  if (const auto unused = list.unused(); !unused.empty())
    return Failure{fmt::format("{} does not read its setting {}", choice.name, unused.front()->name)};
  if (scene.pixel_centres) {
    result->biases.push_back("disablepixeljitter");
    result->notes.push_back(
        "all camera rays go through the centres of pixels (disablepixeljitter of the scene): the picture is "
        "biased, without the pixel filter, depth of field and motion blur");
  }
  // No light arrives where camera rays go through the centres of pixels alone.
  result->search = entry->search_of(list), result->content = entry->content;
  result->abilities = entry->abilities_of(list);
  if (scene.pixel_centres && result->search == LightSearch::both_ends) result->search = LightSearch::any_length;
  result->max_chance_radiance =
      max_chance_radiance(result->chance_lights, result->search, scene, accel, request.width(), request.height());
  if (limit) {
    for (float& radiance : result->max_chance_radiance.c) radiance = std::min(radiance, *limit);
    if (result->coupled)
      result->coupled = std::make_unique<ClampedCoupledIntegrator>(std::move(result->coupled), *limit);
    else
      result->integrator = std::make_unique<ClampedIntegrator>(std::move(result->integrator), *limit);
    result->biases.push_back(fmt::format("maxcomponent={}", *limit));
    result->notes.push_back(fmt::format(
        "samples brighter than {} are scaled down to it: the picture is biased by the light that this takes "
        "away (--set maxcomponent=none lifts it)",
        *limit));
  }
  return result;
}

}  // namespace montelux
