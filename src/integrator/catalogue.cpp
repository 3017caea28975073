#include "integrator/catalogue.h"

#include <fmt/format.h>

#include <algorithm>

#include "integrator/automatic/settings.h"
#include "integrator/bidirectional/bdpt.h"
#include "integrator/bidirectional/vcm.h"
#include "integrator/clamped.h"
#include "integrator/direct/integrator.h"
#include "integrator/distribution/integrator.h"
#include "integrator/irradiance_cache/integrator.h"
#include "integrator/light_paths/light_media.h"
#include "integrator/light_tracing/integrator.h"
#include "integrator/look/integrator.h"
#include "integrator/metropolis/integrator.h"
#include "integrator/missing_light.h"
#include "integrator/path/tracer.h"
#include "integrator/photons/photonmap.h"
#include "integrator/photons/pilot.h"
#include "integrator/photons/sppm.h"
#include "integrator/radiosity/integrator.h"
#include "integrator/restir/integrator.h"
#include "integrator/tracepath/integrator.h"
#include "scene/smoothness.h"

namespace montelux {

namespace {

// The settings of one integrator, read, with the scene they are for.
struct Request {
  const ParameterList& list;
  std::optional<int> max_depth;
  const IntegratorDefaults& defaults;
  const Scene& scene;
  const Accel& accel;
};
using Made = Result<ChosenIntegrator>;

ChosenIntegrator made(std::string_view name, std::unique_ptr<PixelIntegrator> integrator) {
  return {std::string(name), std::move(integrator), {}, {}, {}};
}

void note_depth(ChosenIntegrator& chosen, std::optional<int> max_depth) {
  if (!max_depth) return;
  chosen.biases.push_back(fmt::format("maxdepth={}", *max_depth));
  chosen.notes.push_back(
      fmt::format("paths end after {} scattering events (maxdepth): the picture is biased by what longer paths would "
                  "contribute (--set maxdepth=none lifts it)",
                  *max_depth));
}

// Where light at some surfaces is looked for by points of lights alone.
void note_masked(ChosenIntegrator& chosen, const Scene& scene, std::string_view setting) {
  if (!scene.lights.has_masked()) return;
  chosen.biases.push_back(fmt::format("{} with masked emitters", setting));
  chosen.missing.push_back("direct light of emitters with an alpha mask");
  chosen.notes.push_back(
      fmt::format("emitters with an alpha mask are found only by directions, which {} does not sample: the picture is "
                  "biased by their light",
                  setting));
}

// Where directions are drawn without regard to the BSDF, none of them is that of a smooth coat's reflection.
void note_smooth_coats(ChosenIntegrator& chosen, const Scene& scene, std::string_view setting) {
  const auto is_coated = [&](const GeometryRow& row) { return may_be_partly_smooth(scene.materials, row.material); };
  if (std::ranges::none_of(scene.geometry.rows, is_coated)) return;
  chosen.biases.push_back(fmt::format("{} with smooth coats", setting));
  chosen.missing.push_back("reflections in smooth coats");
  chosen.notes.push_back(
      fmt::format("surfaces here have smooth coats, whose reflections {} cannot find: the picture is biased by their "
                  "light (path finds it)",
                  setting));
}

template <bool naive>
Made make_path(const Request& r) {
  auto settings = path_settings(r.list, r.max_depth);
  if (!settings) return settings.failure();
  if (naive) settings->nee = false;
  if (settings->manifold > 0 && !r.scene.media.empty())
    return Failure{"the scene has participating media, through which manifold does not look for light (manifold=off)"};
  settings->width = r.defaults.width, settings->height = r.defaults.height;
  ChosenIntegrator chosen = made(naive ? "naive" : "path", std::make_unique<PathTracer>(r.scene, r.accel, *settings));
  chosen.chain_length = settings->manifold;
  note_depth(chosen, r.max_depth);
  return chosen;
}

LightSearch path_search(const ParameterList& list) {
  const auto settings = path_settings(list, {});
  return settings && settings->manifold > 0 ? LightSearch::with_chains : LightSearch::any_length;
}

Made make_direct(const Request& r) {
  const DirectSettings settings = direct_settings(r.list);
  ChosenIntegrator chosen = made("direct", std::make_unique<DirectIntegrator>(r.scene, r.accel, settings));
  chosen.biases.push_back("direct light only");
  using enum DirectStrategy;
  const std::string strategy = fmt::format("strategy={}", direct_strategy_names[std::size_t(settings.strategy)]);
  if (settings.strategy == light_area || settings.strategy == light_solid_angle || settings.strategy == ris)
    note_masked(chosen, r.scene, strategy);
  if (settings.strategy != mis && settings.strategy != bsdf) note_smooth_coats(chosen, r.scene, strategy);
  const bool fixed = settings.pattern == PointSetKind::uniform_grid;
  if (fixed) chosen.biases.push_back("fixed shadow rays");
  if (fixed)
    chosen.notes.push_back(
        "the shadow rays go to the same places in every pass: the picture is biased, and its error bar does not show "
        "out");
  return chosen;
}

Made make_distribution(const Request& r) {
  auto settings = distribution_settings(r.list, r.max_depth);
  if (!settings) return settings.failure();
  ChosenIntegrator chosen = made("distribution", std::make_unique<DistributionIntegrator>(r.scene, r.accel, *settings));
  note_depth(chosen, r.max_depth);
  return chosen;
}

Made make_tracepath(const Request& r) {
  TracePathSettings settings = tracepath_settings(r.list);
  settings.max_depth = r.max_depth;
  ChosenIntegrator chosen = made("tracepath", std::make_unique<TracePathIntegrator>(r.scene, r.accel, settings));
  // It aims at flat lamps, and elsewhere evenly.
  for (std::uint32_t i = 0; i < r.scene.lights.count(); ++i)
    if (r.scene.lights.polygon(LightId(i))) {
      note_smooth_coats(chosen, r.scene, "tracepath");
      break;
    }
  note_depth(chosen, r.max_depth);
  return chosen;
}

template <const char* name>
Made make_restir(const Request& r) {
  auto settings = restir_settings(name, r.list, r.max_depth);
  if (!settings) return settings.failure();
  std::string note;
  // A candidate by the BSDF has passed such surfaces by chance, and would be asked by chance again when it is shown.
  if (settings->direct && settings->bsdf_candidate && !settings->visibility_reuse && r.scene.geometry.has_half_open()) {
    settings->visibility_reuse = true;
    note =
        "visibility-reuse is on, because surfaces here have alpha masks or are mixed with interfaces (with bsdf=off it "
        "may be off)";
  }
  ChosenIntegrator chosen{name, {}, {}, {}, std::make_unique<RestirIntegrator>(r.scene, r.accel, *settings)};
  if (!note.empty()) chosen.notes.push_back(std::move(note));
  note_depth(chosen, r.max_depth);
  if (settings->direct && !settings->bsdf_candidate) note_masked(chosen, r.scene, "bsdf=off");
  const bool reuses = settings->temporal || (settings->rounds > 0 && settings->neighbours > 0);
  if (settings->weights == ReuseWeights::naive && reuses) {
    chosen.biases.push_back("weights=naive");
    chosen.notes.push_back(
        "reservoirs are combined as if every pixel could make every sample: the picture is biased where pixels see "
        "different lights (--set weights=pairwise is not)");
  }
  return chosen;
}

constexpr char restir_di[] = "restir-di", restir_gi[] = "restir-gi", restir_pt[] = "restir-pt";

Made make_radiosity(const Request& r) {
  const RadiositySettings settings = radiosity_settings(r.list);
  auto integrator = RadiosityIntegrator::make(r.scene, r.accel, settings);
  if (!integrator) return integrator.failure();
  ChosenIntegrator chosen{"radiosity", {}, {}, {}, *std::move(integrator)};
  chosen.biases.push_back(fmt::format("elementsize={:.4g}", settings.element_size));
  chosen.notes.push_back(
      "irradiance is constant on each element: the picture is biased by their size (--set elementsize=... makes them "
      "smaller)");
  return chosen;
}

void note_facing_curves(ChosenIntegrator& chosen, const Scene& scene) {
  const auto turns = [](const GeometryRow& row) { return (row.flags & GeometryRow::ray_facing) != 0; };
  if (std::ranges::none_of(scene.geometry.rows, turns)) return;
  chosen.biases.push_back("curves that face the light");
  chosen.notes.push_back(
      "curves face every ray that meets them, and here rays come from the lights: the picture is biased where the "
      "shape of a curve matters");
}

Made make_light(const Request& r) {
  auto integrator = LightTracer::make(r.scene, r.accel, light_tracing_settings(r.list, r.max_depth));
  if (!integrator) return integrator.failure();
  ChosenIntegrator chosen{"light", {}, {}, {}, *std::move(integrator)};
  note_depth(chosen, r.max_depth);
  if (r.scene.lights.has_masked()) {
    chosen.biases.push_back("no masked emitters");
    chosen.missing.push_back("light of emitters with an alpha mask");
    chosen.notes.push_back("no path starts at emitters with an alpha mask: the picture is biased by their light");
  }
  if (!r.scene.camera.sees_directions() && r.scene.lights.infinite_count() > 0) {
    chosen.biases.push_back("no sky behind the scene");
    chosen.missing.push_back("the sky that the camera sees directly");
    chosen.notes.push_back(
        "an orthographic camera sees the sky in a few directions, which no path from the sky takes: the picture is "
        "black where no surface is");
  }
  if (r.scene.media.emits()) {
    chosen.biases.push_back("no emission of media");
    chosen.missing.push_back("light that media emit");
    chosen.notes.push_back("no path starts in a medium that emits: the picture is biased by its light");
  }
  note_facing_curves(chosen, r.scene);
  return chosen;
}

void note_radius(ChosenIntegrator& chosen, float radius) {
  chosen.biases.push_back(fmt::format("radius={:.4g}", radius));
  chosen.notes.push_back(fmt::format(
      "photons are gathered within {:.4g} at first: the picture is biased where light changes over that distance; more "
      "frames, or a smaller radius, bias it less",
      radius));
}

Status check_medium_radius(float radius, const Scene& scene) {
  if (radius > 0 && scene.media.empty())
    return Failure{"medium-radius is for participating media, and the scene has none"};
  return Done{};
}

void note_photons(ChosenIntegrator& chosen, const Scene& scene, float medium_radius) {
  if (!scene.media.empty()) {
    chosen.biases.push_back(fmt::format("medium-radius={:.4g}", medium_radius));
    chosen.notes.push_back(
        fmt::format("in participating media photons are gathered within {:.4g} at first: the picture is biased where "
                    "light or the medium changes over that distance (see medium-radius)",
                    medium_radius));
  }
  if (scene.media.emits()) {
    chosen.biases.push_back("no photons of media");
    chosen.missing.push_back("indirect light of media that emit");
    chosen.notes.push_back("no photon starts in a medium that emits: the picture is biased by its indirect light");
  }
  if (scene.lights.has_masked()) {
    chosen.biases.push_back("no photons of masked emitters");
    chosen.missing.push_back("indirect light of emitters with an alpha mask");
    chosen.notes.push_back(
        "no photon starts at emitters with an alpha mask: the picture is biased by their indirect light");
  }
  note_facing_curves(chosen, scene);
}

Made make_sppm(const Request& r) {
  auto settings = sppm_settings(r.list, r.max_depth);
  if (!settings) return settings.failure();
  if (Status used = check_medium_radius(settings->medium_radius, r.scene); !used) return used.failure();
  const int width = std::max(r.defaults.width, 1), height = std::max(r.defaults.height, 1);
  if (settings->medium_radius == 0 && !r.scene.media.empty())
    settings->medium_radius =
        medium_radius_by_photons(PhotonPilot(r.scene, r.accel, sppm_paths(*settings, width * height)));
  if (settings->radius == 0) settings->radius = radius_by_footprint(r.scene, r.accel, width, height);
  ChosenIntegrator chosen{"sppm", {}, {}, {}, std::make_unique<SppmIntegrator>(r.scene, r.accel, *settings)};
  note_radius(chosen, settings->radius);
  note_depth(chosen, r.max_depth);
  note_photons(chosen, r.scene, settings->medium_radius);
  return chosen;
}

Made make_photonmap(const Request& r) {
  auto settings = photonmap_settings(r.list, r.max_depth);
  if (!settings) return settings.failure();
  const int width = std::max(r.defaults.width, 1), height = std::max(r.defaults.height, 1);
  if (Status used = check_medium_radius(settings->medium_radius, r.scene); !used) return used.failure();
  const bool in_media = !r.scene.media.empty();
  if (settings->radius == 0 || (in_media && settings->medium_radius == 0)) {
    const PhotonPilot pilot(r.scene, r.accel, global_paths(*settings, width * height));
    if (settings->radius == 0) settings->radius = radius_by_photons(pilot, *settings);
    if (in_media && settings->medium_radius == 0) settings->medium_radius = medium_radius_by_photons(pilot, *settings);
  }
  if (settings->caustic_radius == 0) settings->caustic_radius = radius_by_footprint(r.scene, r.accel, width, height);
  ChosenIntegrator chosen{"photonmap", {}, {}, {}, std::make_unique<PhotonMapIntegrator>(r.scene, r.accel, *settings)};
  const std::string nearest =
      settings->nearest > 0 ? fmt::format("the {} nearest photons", settings->nearest) : "the photons";
  chosen.biases.push_back(fmt::format("radius={:.4g}", settings->radius));
  if (settings->gather_rays > 0) {
    chosen.biases.push_back(fmt::format("caustic-radius={:.4g}", settings->caustic_radius));
    chosen.notes.push_back(fmt::format(
        "light is estimated by {} within {:.4g} at the ends of gather rays, and within {:.4g} for caustics: the "
        "picture "
        "is biased where light changes over that distance (more photons bias it less, see radius, caustic-radius and "
        "nearest)",
        nearest, settings->radius, settings->caustic_radius));
  } else {
    chosen.notes.push_back(
        fmt::format("light is estimated by {} within {:.4g} of the surfaces in view: the picture is biased where light "
                    "changes over "
                    "that distance (more photons bias it less, see radius and nearest)",
                    nearest, settings->radius));
  }
  note_depth(chosen, r.max_depth);
  note_photons(chosen, r.scene, settings->medium_radius);
  return chosen;
}

Made make_irradiance_cache(const Request& r) {
  auto settings = irradiance_cache_settings(r.list, r.max_depth);
  if (!settings) return settings.failure();
  if (r.scene.geometry.moves())
    return Failure{"irradiance-cache is only for scenes without motion; \"path\" supports all"};
  // The least radius by the footprint of the pixels, which radius_by_footprint states for three of them.
  if (settings->min_spacing == 0)
    settings->min_spacing =
        radius_by_footprint(r.scene, r.accel, std::max(r.defaults.width, 1), std::max(r.defaults.height, 1)) *
        (2.0f / 3);
  if (settings->max_spacing == 0) {
    const float diagonal = r.scene.bounds.is_empty() ? 1.0f : length(r.scene.bounds.high - r.scene.bounds.low);
    settings->max_spacing = std::max(0.05f * diagonal, settings->min_spacing);
  }
  ChosenIntegrator chosen{
      "irradiance-cache", {}, {}, {}, std::make_unique<IrradianceCacheIntegrator>(r.scene, r.accel, *settings)};
  chosen.biases.push_back(fmt::format("accuracy={:.4g}", settings->accuracy));
  chosen.notes.push_back(
      fmt::format("indirect light at diffuse surfaces is interpolated within {:.4g} of its distance from other "
                  "surfaces: the picture is biased where it changes faster (--set accuracy=... bounds it)",
                  settings->accuracy));
  note_depth(chosen, r.max_depth);
  return chosen;
}

Made make_bdpt(const Request& r) {
  ChosenIntegrator chosen{
      "bdpt", {}, {}, {}, std::make_unique<BdptIntegrator>(r.scene, r.accel, bdpt_settings(r.list, r.max_depth))};
  note_depth(chosen, r.max_depth);
  note_facing_curves(chosen, r.scene);
  return chosen;
}

Made make_vcm(const Request& r) {
  VcmSettings settings = vcm_settings(r.list, r.max_depth);
  if (!settings.paths.connect && !r.scene.media.empty())
    return Failure{
        "the scene has participating media, where vcm does not merge vertices: there it needs connections "
        "(--set connect=on)"};
  if (settings.radius == 0)
    settings.radius =
        radius_by_footprint(r.scene, r.accel, std::max(r.defaults.width, 1), std::max(r.defaults.height, 1));
  ChosenIntegrator chosen{"vcm", {}, {}, {}, std::make_unique<VcmIntegrator>(r.scene, r.accel, settings)};
  note_radius(chosen, settings.radius);
  note_depth(chosen, r.max_depth);
  if (!settings.paths.connect && r.scene.lights.has_masked()) {
    chosen.biases.push_back("no photons of masked emitters");
    chosen.missing.push_back("light of emitters with an alpha mask");
    chosen.notes.push_back("no photon starts at emitters with an alpha mask: the picture is biased by their light");
  }
  note_facing_curves(chosen, r.scene);
  return chosen;
}

Made make_metropolis(const Request& r) {
  MetropolisSettings settings = metropolis_settings(r.list, r.max_depth);
  settings.width = r.defaults.width, settings.height = r.defaults.height;
  ChosenIntegrator chosen{"metropolis", {}, {}, {}, std::make_unique<MetropolisIntegrator>(r.scene, r.accel, settings)};
  note_depth(chosen, r.max_depth);
  if (settings.strategies == MetropolisStrategies::bdpt) note_facing_curves(chosen, r.scene);
  return chosen;
}

bool from_both_ends(const ParameterList& list) {
  return metropolis_settings(list, {}).strategies == MetropolisStrategies::bdpt;
}
LightSearch metropolis_search(const ParameterList& list) {
  return from_both_ends(list) ? LightSearch::both_ends : LightSearch::any_length;
}
std::uint32_t metropolis_abilities(const ParameterList& list) {
  return from_both_ends(list) ? std::uint32_t(Ability::strategies) : 0;
}

// Path, since nothing is known of the render: the choice is made where its length is known.
Made make_automatic(const Request& r) {
  auto settings = automatic_settings(r.list);
  if (!settings) return settings.failure();
  for (const std::string& text : settings->among) {
    auto choice = parse_choice(text);
    if (!choice) return Failure{"among: " + choice.error()};
    if (choice->name == "auto") return Failure{"among: auto cannot be one of its own candidates"};
    if (Status known = check_integrator(*choice); !known) return Failure{"among: " + known.error()};
  }
  PathSettings path;
  path.max_depth = r.max_depth;
  ChosenIntegrator chosen = made("auto", std::make_unique<PathTracer>(r.scene, r.accel, path));
  note_depth(chosen, r.max_depth);
  return chosen;
}

template <const char* name>
Made make_look(const Request& r) {
  ChosenIntegrator chosen = made(name, std::make_unique<LookIntegrator>(r.scene, r.accel, look_settings(name, r.list)));
  chosen.biases.push_back("no picture of light");
  return chosen;
}
constexpr char ao[] = "ao", normal[] = "normal", albedo[] = "albedo", depth[] = "depth", irradiance[] = "irradiance";

struct Row {
  EntitySpec spec;
  Made (*make)(const Request&);
  LightSearch search = LightSearch::any_length;
  Content content = Content::light;
  std::uint32_t abilities = 0;
  LightSearch (*search_by)(const ParameterList&) = nullptr;         // instead of `search`, where settings decide
  std::uint32_t (*more_abilities)(const ParameterList&) = nullptr;  // where settings add some
  LightSearch search_of(const ParameterList& list) const { return search_by ? search_by(list) : search; }
  std::uint32_t abilities_of(const ParameterList& list) const {
    return abilities | (more_abilities ? more_abilities(list) : 0);
  }
  bool can(Ability ability) const { return (abilities & std::uint32_t(ability)) != 0; }
};

constexpr std::uint32_t only_layers = std::uint32_t(Ability::layers),
                        all_abilities = only_layers | std::uint32_t(Ability::media) | std::uint32_t(Ability::paths),
                        shared_samples = std::uint32_t(Ability::shared_samples),
                        shared_in_media = shared_samples | std::uint32_t(Ability::media),
                        bidirectional = shared_in_media | only_layers | std::uint32_t(Ability::strategies),
                        shared_with_layers = shared_samples | only_layers, photons = shared_in_media | only_layers,
                        with_mergings = bidirectional | std::uint32_t(Ability::mergings);

// The one table of integrators.
const std::vector<Row>& rows() {
  static const std::vector<Row> table = [] {
    std::vector<Row> all{
        {path_spec(), make_path<false>, LightSearch::any_length, Content::light, all_abilities, path_search},
        {naive_spec(), make_path<true>, LightSearch::any_length, Content::light, all_abilities, path_search},
        {direct_spec(), make_direct, LightSearch::one_event, Content::light, only_layers},
        {distribution_spec(), make_distribution, LightSearch::any_length, Content::light, only_layers},
        {tracepath_spec(), make_tracepath},
        {restir_di_spec(), make_restir<restir_di>, LightSearch::any_length, Content::light, shared_samples},
        {restir_gi_spec(), make_restir<restir_gi>, LightSearch::any_length, Content::light, shared_samples},
        {restir_pt_spec(), make_restir<restir_pt>, LightSearch::any_length, Content::light, shared_samples},
        {radiosity_spec(), make_radiosity, LightSearch::diffuse, Content::light, shared_samples},
        {light_tracing_spec(), make_light, LightSearch::from_lights, Content::light, bidirectional},
        {sppm_spec(), make_sppm, LightSearch::photons, Content::light, photons},
        {photonmap_spec(), make_photonmap, LightSearch::photons, Content::light, photons},
        {bdpt_spec(), make_bdpt, LightSearch::both_ends, Content::light, bidirectional},
        {irradiance_cache_spec(), make_irradiance_cache, LightSearch::any_length, Content::light, shared_with_layers},
        {vcm_spec(), make_vcm, LightSearch::photons, Content::light, with_mergings},
        {metropolis_spec(), make_metropolis, LightSearch::any_length, Content::light, shared_in_media | only_layers,
         metropolis_search, metropolis_abilities},
        {automatic_spec(), make_automatic, LightSearch::any_length, Content::light, all_abilities}};
    constexpr Made (*looks[])(const Request&) = {make_look<ao>, make_look<normal>, make_look<albedo>, make_look<depth>,
                                                 make_look<irradiance>};
    const std::vector<EntitySpec> specs = look_specs();
    using enum Content;
    constexpr Content contents[] = {share, encoded, share, distance, light};
    for (std::size_t i = 0; i < specs.size(); ++i) all.push_back({specs[i], looks[i], LightSearch::none, contents[i]});
    for (Row& row : all)
      row.spec.parameters.push_back({"maxcomponent",
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

// The row of the table that is meant, and its settings.
Result<std::pair<const Row*, ParameterList>> read_choice(const ChoiceText& choice) {
  for (const Row& row : rows()) {
    if (row.spec.name != choice.name) continue;
    auto list = read_settings(row.spec, choice.settings, "integrator");
    if (!list) return list.failure();
    return std::pair{&row, *std::move(list)};
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
    for (const Row& row : rows()) all.push_back(row.spec);
    return all;
  }();
  return specs;
}

std::vector<std::string_view> integrators_with(Ability ability) {
  std::vector<std::string_view> names;
  for (const Row& row : rows())
    if (row.can(ability)) names.push_back(row.spec.name);
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
  for (const Row& row : rows())
    if (row.spec.name == name) {
      const auto choice = parse_choice(text);
      if (!choice) return row.search;
      const auto read = read_choice(*choice);
      return read ? row.search_of(read->second) : row.search;
    }
  return LightSearch::none;
}

int chain_length(std::string_view text) {
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
  const auto& [row, list] = *read;

  if (!scene.media.empty() && !row->can(Ability::media))
    return Failure{fmt::format("the scene has participating media, which {} cannot cross; {} can", row->spec.name,
                               listed(integrators_with(Ability::media)))};

  const auto typed_depth = list.find("maxdepth") ? std::optional(list.integer("maxdepth", 0)) : std::nullopt;
  const auto typed_limit = list.find("maxcomponent") ? std::optional(list.number("maxcomponent", 0)) : std::nullopt;
  const auto limit = stated(choice, "maxcomponent", typed_limit, defaults.max_component);
  const Request request{list, stated(choice, "maxdepth", typed_depth, defaults.max_depth), defaults, scene, accel};
  Made result = row->make(request);
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
  result->search = row->search_of(list), result->content = row->content;
  result->abilities = row->abilities_of(list);
  if (scene.pixel_centres && result->search == LightSearch::both_ends) result->search = LightSearch::any_length;
  if (limit) {
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
