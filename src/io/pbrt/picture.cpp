#include "io/pbrt/picture.h"

#include <algorithm>

#include "camera/table.h"
#include "filter/table.h"
#include "io/checks.h"
#include "io/numbers.h"
#include "io/pbrt/picture_models.h"
#include "io/read_model.h"

namespace montelux::pbrt {

namespace {

// What the entity states; the checks have reported values that cannot be read.
template <class S>
S read(const Models<S>& models, const Entity& stated, Family family, SceneDesc& scene, Reporter& report) {
  // A default that the file does not state is not replaced.
  const EntitySpec* spec = find_entity(models.specs(), stated.type);
  if (stated.where.file && spec && !spec->instead.empty())
    scene.replaced.push_back({std::string(name_of(family)), stated.type, std::string(spec->instead)});
  const std::optional<S> result = read_model(models, family, stated, report);
  return result ? *result : models.initial(stated.type);
}

SourceLocation place_of(const Entity& entity, std::string_view parameter) {
  const Parameter* p = entity.parameters.find(parameter);
  return p ? p->where : entity.where;
}

SamplingDesc sampling_of(const StatedSampler& s, const StatedOptions& options, const Entity& entity, Reporter& report) {
  SamplingDesc sampling{s.points, s.samples, std::uint32_t(s.seed.value_or(options.seed.value_or(0))),
                        options.pixel_centres};
  if (s.points == PointSetKind::stratified) sampling.samples = s.x_strata * s.y_strata;
  if (!s.jitter) {
    sampling.points = PointSetKind::uniform_grid;
    const int columns = int(grid_columns(std::uint32_t(sampling.samples)));
    if (s.x_strata != columns)
      report.warning(place_of(entity, "jitter"),
                     std::to_string(s.x_strata) + " x " + std::to_string(s.y_strata) + " strata without jitter: the " +
                         std::to_string(sampling.samples) + " samples are at the centres of a grid with " +
                         std::to_string(columns) + " columns instead of " + std::to_string(s.x_strata));
  }
  if (s.randomization == "none" || s.randomization == "permutedigits")
    report.warning(place_of(entity, "randomization"), "points are scrambled by Owen's method instead of by \"" +
                                                          s.randomization +
                                                          "\": error bars need passes that are random");
  return sampling;
}

LightSelection selection_of(StatedLightSampler stated) {
  switch (stated) {
    case StatedLightSampler::uniform:
      return LightSelection::uniform;
    case StatedLightSampler::power:
      return LightSelection::power;
    case StatedLightSampler::bvh:
    case StatedLightSampler::exhaustive:
      break;
  }
  return LightSelection::bvh;
}

// Ours, with its settings as for --integrator.
IntegratorDesc integrator_of(const StatedIntegrator& s, const Entity& entity, Reporter& report) {
  IntegratorDesc integrator{s.name, {}, s.max_depth, selection_of(s.light_sampler), entity.where};
  auto& settings = integrator.settings;
  if (s.max_distance) settings.emplace_back("distance", shortest(*s.max_distance));
  if (!s.cosine_directions) settings.emplace_back("cossample", "off");
  if (s.photons > 0) settings.emplace_back("photons", std::to_string(s.photons));
  if (s.radius) settings.emplace_back("radius", shortest(*s.radius));
  // Pairs of subpaths, as in pbrt.
  if (s.name == "metropolis") settings.emplace_back("strategies", "bdpt");
  if (s.large_step) settings.emplace_back("large-step", shortest(*s.large_step));
  if (!s.sample_lights) integrator.name = "naive";
  if (s.light_sampler == StatedLightSampler::exhaustive)
    report.note(entity.where, "light sampler \"exhaustive\" is replaced by \"bvh\"");
  return integrator;
}

// ---- writing --------------------------------------------------------------------------------------------------------

Entity stated_sampler(const SamplingDesc& sampling) {
  StatedSampler s{sampling.points, sampling.samples};
  if (sampling.seed != 0) s.seed = int(sampling.seed);
  s.x_strata = int(grid_columns(std::uint32_t(sampling.samples)));
  s.y_strata = sampling.samples / s.x_strata;
  s.jitter = sampling.points != PointSetKind::uniform_grid;
  std::string_view name = "zsobol";
  if (!s.jitter || sampling.points == PointSetKind::stratified)
    name = "stratified";
  else if (sampling.points == PointSetKind::padded_sobol)
    name = "paddedsobol";
  else if (find_entity(sampler_models().specs(), name_of(sampling.points)))
    name = name_of(sampling.points);
  return sampler_models().write(name, s);
}

Entity stated_integrator(const IntegratorDesc& integrator) {
  StatedIntegrator s{integrator.name};
  s.max_depth = integrator.max_depth;
  if (integrator.light_selection == LightSelection::uniform) s.light_sampler = StatedLightSampler::uniform;
  if (integrator.light_selection == LightSelection::power) s.light_sampler = StatedLightSampler::power;
  for (const auto& [name, value] : integrator.settings) {
    if (name == "distance") s.max_distance = to_float(value);
    if (name == "cossample") s.cosine_directions = value != "off";
    if (name == "photons") s.photons = to_integer(value).value_or(-1);
    if (name == "radius") s.radius = to_float(value);
    if (name == "large-step") s.large_step = to_float(value);
  }
  const Models<StatedIntegrator>& models = integrator_models();
  if (integrator.name == "naive") {
    s.sample_lights = false;
    return models.write("simplepath", s);
  }
  std::string_view word = "volpath";
  for (const EntitySpec& spec : models.specs())
    if (integrator.name != "path" && models.initial(spec.name).name == integrator.name) word = spec.name;
  return models.write(word, s);
}

}  // namespace

void describe_picture(const StatedPicture& stated, SceneDesc& scene, Reporter& report) {
  scene.replaced.clear();
  const StatedIntegrator integrator = read(integrator_models(), stated.integrator, Family::integrator, scene, report);
  const StatedSampler sampler = read(sampler_models(), stated.sampler, Family::sampler, scene, report);
  const StatedOptions options = read(option_models(), {"Option", stated.options, {}}, Family::option, scene, report);
  scene.integrator = integrator_of(integrator, stated.integrator, report);
  scene.sampling = sampling_of(sampler, options, stated.sampler, report);
  if (integrator.mutations) scene.sampling.samples = *integrator.mutations;
  if (integrator.seed) scene.sampling.seed = std::uint32_t(*integrator.seed);
  scene.film = read(film_models(), stated.film, Family::film, scene, report);
  scene.film.where = stated.film.where;
  scene.filter = read(filter_models(), stated.filter, Family::filter, scene, report);
  scene.camera = read(camera_models(), stated.camera, Family::camera, scene, report);
  scene.camera.where = stated.camera.where;
  report_unused("accelerator '" + stated.accelerator.type + "'", stated.accelerator.parameters, report);
}

StatedPicture stated_picture(const SceneDesc& scene) {
  StatedPicture stated;
  stated.camera = camera_models().write(name_of(scene.camera.kind), scene.camera);
  stated.film = film_models().write("rgb", scene.film);
  stated.filter = filter_models().write(name_of(scene.filter.kind), scene.filter);
  stated.sampler = stated_sampler(scene.sampling);
  stated.integrator = stated_integrator(scene.integrator);
  stated.options = option_models().write("Option", {{}, scene.sampling.pixel_centres}).parameters;
  return stated;
}

}  // namespace montelux::pbrt
