#include "api/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "api/comparison.h"
#include "api/film_keeper.h"
#include "api/parts.h"
#include "api/shortcomings.h"
#include "api/trace.h"
#include "integrator/catalogue.h"
#include "integrator/direct/settings.h"
#include "integrator/missing_light.h"
#include "render/motion.h"

namespace montelux {

namespace {

constexpr std::string_view montelux_version = MONTELUX_VERSION;

std::vector<std::string_view> views_of(const std::vector<std::pair<std::string, std::string>>& named) {
  std::vector<std::string_view> names;
  for (const auto& [name, description] : named) names.push_back(name);
  return names;
}

// The requested layers that exist for the scene.
Result<LayerPlan> plan_layers(const LayerRequest& request, const ChosenIntegrator& chosen, const Scene& scene) {
  if (!chosen.integrator || !chosen.integrator->has_layers()) {
    const bool clamped =
        std::ranges::any_of(chosen.biases, [](const std::string& bias) { return bias.starts_with("maxcomponent="); });
    if (clamped)
      return Failure{
          "samples that are scaled down to maxcomponent have no layers; --set maxcomponent=none removes the limit"};
    return Failure{
        fmt::format("the integrator {} has no layers; path, naive, direct and distribution have them", chosen.name)};
  }
  LayerPlan plan;
  plan.bounces = request.bounces;
  plan.light_groups = request.light_groups;
  plan.spread = request.errors;
  state_light_groups(plan, scene);
  if (plan.group_names.empty()) plan.group_names = {"default"};
  return plan;
}

// Everything that decides a render, checked.
struct Plan {
  RenderSettings render;
  ChosenIntegrator chosen;
  std::vector<Replacement> replaced;
  FilesToWrite files;
  std::string way;                      // the integrator, with its settings
  std::optional<int> samples_per_pass;  // that are requested
  bool motion = false;                  // of a sequence
  double preparation = 0;               // seconds that the making of the integrator took: pilots, meshes of elements
};

Shutter shutter_for(const ShutterTimes& times, const PictureSettings& picture) {
  return shutter_of(times.open, times.close, picture.transforms_start, picture.transforms_end);
}

// "direct:candidates=4,strategy=ris", whatever the order in which the settings were given.
std::string way_of(const ChoiceText& choice) {
  std::vector<std::string> settings;
  for (const auto& [key, value] : choice.settings) settings.push_back(fmt::format("{}={}", key, value));
  std::ranges::stable_sort(settings);
  return choice.name + (settings.empty() ? "" : ":") + fmt::format("{}", fmt::join(settings, ","));
}

// The plan with passes of so many samples, and of these the ones that are wanted.
Status plan_passes(const RenderOptions& options, const AnyIntegrator& integrator, RenderSettings& r) {
  constexpr int endless = 1 << 20;  // time ends it
  const int samples = r.plan.samples();
  if (const auto& k = options.samples_per_pass; k && *k != r.plan.samples_per_pass) {
    if (*k < 1 || *k > max_fixed_samples)
      return Failure{fmt::format("a pass has from 1 to {} samples per pixel; found {}", max_fixed_samples, *k)};
    // A saved film has those that it was made with.
    const bool as_saved = options.resume && !options.samples;
    if (is_fixed(r.sampler) && !as_saved)
      return Failure{
          fmt::format("sampler {} takes all its samples in one pass, and has no others", name_of(r.sampler))};
    if (integrator.coupled() && *k > integrator.coupled()->frames())
      return Failure{fmt::format("a pass is a chain of at most {} frames here; found {} samples a pass",
                                 integrator.coupled()->frames(), *k)};
    r.plan = {*k, is_fixed(r.sampler) ? 1 : (samples + *k - 1) / *k};
  }
  if (options.resume && options.seconds && !is_fixed(r.sampler)) r.plan.passes = endless;
  if (const auto& range = options.passes) {
    const bool further = options.resume && !options.samples;  // than the scene's number of samples
    if (!further && range->last >= r.plan.passes)
      return Failure{fmt::format("there is no pass {}: {} samples per pixel are {} passes of {}, from 0 to {}",
                                 range->last, samples, r.plan.passes, r.plan.samples_per_pass, r.plan.passes - 1)};
    r.first_pass = range->first, r.plan.passes = range->count();
  }
  return Done{};
}

Result<Plan> plan_render(const LoadedScene::Parts& parts, const RenderOptions& options) {
  const PictureSettings& picture = parts.picture;
  Plan plan;
  const DirectPreset* preset = nullptr;
  if (options.preset) {
    for (const DirectPreset& candidate : direct_presets())
      if (candidate.name == *options.preset) preset = &candidate;
    const auto names = preset_names();
    if (!preset) return unknown_name("preset", *options.preset, views_of(names));
  }
  auto choice =
      parse_choice(options.integrator.value_or(preset ? std::string(preset->integrator) : picture.integrator));
  if (!choice) return choice.failure();
  choice->settings.insert(choice->settings.end(), options.settings.begin(), options.settings.end());
  plan.way = way_of(*choice);
  const Stopwatch since_choice;
  auto chosen = choose_integrator(*choice, integrator_defaults(picture), parts.scene, *parts.accel);
  if (!chosen) return chosen.failure();
  plan.chosen = *std::move(chosen);
  note_light(plan.chosen, parts);
  plan.replaced = replaced_in(parts.info, options.integrator || preset, options.sampler.has_value());
  plan.preparation = since_choice.seconds();
  plan.motion = options.layers && options.layers->motion;
  if (options.layers && options.layers->of_light()) {
    auto layers = plan_layers(*options.layers, plan.chosen, parts.scene);
    if (!layers) return layers.failure();
    plan.render.layers = *std::move(layers);
  }

  RenderSettings& r = plan.render;
  r.sampler = picture.sampler;
  if (options.sampler) {
    auto kind = point_set_named(*options.sampler);
    const auto samplers = sampler_names();
    if (!kind) return unknown_name("sampler", *options.sampler, views_of(samplers));
    r.sampler = *kind;
  }
  if (is_fixed(r.sampler) && (options.budget || plan.chosen.coupled))
    return Failure{fmt::format("sampler {} uses the same points in every pass, but {} needs different ones",
                               name_of(r.sampler), options.budget ? "a time budget" : plan.chosen.name)};
  note_sampler(plan.chosen, r.sampler);
  r.width = picture.width, r.height = picture.height;
  r.bounds = options.crop.value_or(picture.crop);
  const PixelBounds& b = r.bounds;
  if (b.x0 < 0 || b.y0 < 0 || b.x1 > r.width || b.y1 > r.height || b.x0 >= b.x1 || b.y0 >= b.y1)
    return Failure{fmt::format("the crop {},{},{},{} is not inside the picture of {} x {} pixels", b.x0, b.y0, b.x1,
                               b.y1, r.width, r.height)};
  if (options.samples && (*options.samples < 1 || *options.samples > (1 << 24)))
    return Failure{fmt::format("the number of samples must be from 1 to {}; found {}", 1 << 24, *options.samples)};
  r.seed = options.seed.value_or(picture.seed);
  r.threads = options.threads;
  if (options.shutter) r.shutter = shutter_for(*options.shutter, picture);
  r.seconds = options.seconds;
  plan.files = options.files, plan.samples_per_pass = options.samples_per_pass;
  if (options.budget && (options.seconds || options.samples || plan.render.layers))
    return Failure{"a time budget replaces the number of samples and the time, and does not support layers of light"};
  if (options.budget) r.budget = {*options.budget, 0};
  r.plan = options.budget
               ? plan_for_budget(plan.chosen.any())
               : plan_passes(plan.chosen.any(), options.samples.value_or(preset ? preset->eye_rays : picture.samples),
                             r.sampler);
  if (Status good = plan_passes(options, plan.chosen.any(), r); !good) return good.failure();
  if (is_fixed(r.sampler) && r.plan.samples_per_pass > max_fixed_samples)
    return Failure{fmt::format("sampler {} supports at most {} samples, all in one pass; found {}", name_of(r.sampler),
                               max_fixed_samples, r.plan.samples_per_pass)};
  return plan;
}

// The plan within the time that is left: the making of the integrator has taken `before`, which grows by what this
// takes, and in the end the picture is written.
void plan_timed(const AnyIntegrator& integrator, const Plan& plan, RenderSettings& settings, double& before,
                RenderObserver& observer) {
  // Of the time, what is rendered in however long the rest takes.
  constexpr double min_share = 0.1;
  const double all = *settings.seconds;
  const Stopwatch since_start;
  const auto left = [&](double end) { return std::max(end - before - since_start.seconds(), min_share * all); };
  const FinishTime finish = seconds_to_finish(settings.bounds, plan.files);
  const double end = all - finish.error - finish.encoding;
  const auto announce_if_late = [&](double encoding) {
    if (left(all - encoding) > min_share * all) return;
    observer.announce(fmt::format("preparing and writing the image takes about {:.2g} s in addition to the time",
                                  before + since_start.seconds() + encoding));
  };
  if (settings.begun) {
    announce_if_late(finish.encoding);
    settings.seconds = left(end);
    before += since_start.seconds();
    return;
  }
  TimedPlan timed = plan_for_time(integrator, settings, left(end), observer);
  if (plan.samples_per_pass) timed.plan.samples_per_pass = *plan.samples_per_pass;
  if (settings.keeping.keep && timed.stride > 1) {
    observer.announce(
        fmt::format("one sample of every pixel takes about {:.2g} s, more than the time: a film that is "
                    "saved has one all the same",
                    timed.sample_seconds));
    timed.stride = 1;
  }
  settings.plan = timed.plan, settings.stride = timed.stride, settings.max_unit_samples = timed.max_unit_samples;
  const double encoding = timed.stride > 1 ? finish.encoding_of(timed.stride) : finish.encoding;
  announce_if_late(encoding);
  if (timed.stride > 1)
    observer.announce(fmt::format("one sample per pixel takes about {:.2g} s, more than the time: {}",
                                  timed.sample_seconds, sparse_text(timed.stride)));
  else if (integrator.coupled() && timed.sample_seconds > left(end))
    observer.announce(fmt::format("one frame takes about {:.2g} s, more than the time: the image is one frame",
                                  timed.sample_seconds));
  // The error of a sparse picture is not estimated.
  settings.seconds = left(timed.stride > 1 ? all - encoding : end);
  before += since_start.seconds();
}

PictureFacts facts_of(const LoadedScene::Parts& parts, const Plan& plan, const RenderSettings& settings) {
  return {std::filesystem::path(parts.info.file).filename().string(),
          plan.chosen.name,
          std::string(name_of(settings.sampler)),
          settings.seed,
          settings.plan.samples_per_pass,
          plan.chosen.biases,
          plan.chosen.notes,
          plan.chosen.missing,
          parts.info.left_out,
          plan.replaced,
          plan.chosen.content,
          parts.info.states_exposure,
          settings.layers};
}

// Of the scene, without the files that renders of it write.
std::uint64_t fingerprint_of(const LoadedScene::Parts& parts, const RenderOptions& options) {
  std::vector<std::string> written;
  const auto add = [&](const std::filesystem::path& file) { written.push_back(file.filename().string()); };
  add(parts.info.picture_file);
  for (const auto& file : options.files.paths) add(file);
  if (options.checkpoint) add(options.checkpoint->file);
  return scene_fingerprint(parts.info.file, parts.load.environment, written);
}

// What the film of a render is of; the film itself is not in it.
SavedFilm description_of(const LoadedScene::Parts& parts, const Plan& plan, const RenderSettings& r,
                         const RenderOptions& options) {
  LoadOptions load = parts.load;
  load.resolution = {r.width, r.height}, load.resolution_scale.reset();
  SavedFilm film{std::filesystem::absolute(parts.info.file),
                 load,
                 fingerprint_of(parts, options),
                 {plan.way, std::string(name_of(r.sampler)), options.layers ? to_text(*options.layers) : "", r.seed,
                  r.plan.samples_per_pass, r.width, r.height, r.bounds},
                 options,
                 {},
                 facts_of(parts, plan, r),
                 {Film({}), {}, 0}};
  if (!options.seconds) film.wanted = PassRange{r.first_pass, r.first_pass + r.plan.passes - 1};
  return film;
}

// One picture, as the plan is except seed, shutter and memories. What the end of a picture takes goes into the plan;
// `film`, where there is one, learns how long passes are, and what the preparation took.
Rendering render_picture(const LoadedScene::Parts& parts, Plan& plan, RenderSettings settings, RenderObserver& observer,
                         SavedFilm* film = nullptr) {
  const AnyIntegrator integrator = plan.chosen.any();
  // The integrator is made once, and that counts for the first picture of a sequence.
  double before = std::exchange(plan.preparation, 0.0);
  if (settings.seconds) {
    // The time includes the making of the integrator, the measurement of its speed, and the writing of the picture.
    plan_timed(integrator, plan, settings, before, observer);
  }
  if (film) {
    film->settings.samples_per_pass = film->facts.samples_per_pass = settings.plan.samples_per_pass;
    film->begun.seconds = before;
  }
  if (settings.budget) settings.budget->seconds -= before;
  RenderResult result = render(integrator, settings, observer);
  result.seconds += before;
  if (settings.budget) {
    const PixelBounds& b = settings.bounds;
    const int passes = std::max(result.film.image().passes, 1);
    settings.plan = {int(result.film.samples(b.x0, b.y0)) / passes, passes};
    plan.render.budget->ending = result.ending;
  }
  return rendering_of(facts_of(parts, plan, settings), std::move(result), settings.plan);
}

}  // namespace

struct PictureSequence::State {
  const LoadedScene::Parts& parts;
  Plan plan;
  ChainMemories memories;
};

PictureSequence::PictureSequence(std::unique_ptr<State> state) : state_(std::move(state)) {}
PictureSequence::~PictureSequence() = default;
PictureSequence::PictureSequence(PictureSequence&&) noexcept = default;

Result<PictureSequence> PictureSequence::prepare(const LoadedScene& scene, const RenderOptions& options) {
  Result<Plan> plan = plan_render(scene.parts(), options);
  if (!plan) return plan.failure();
  return PictureSequence(std::make_unique<State>(State{scene.parts(), *std::move(plan), {}}));
}

Rendering PictureSequence::render(const SequencePicture& picture, RenderObserver& observer) {
  const LoadedScene::Parts& parts = state_->parts;
  RenderSettings settings = state_->plan.render;
  settings.seed = picture.seed, settings.memories = &state_->memories;
  if (picture.is_last) settings.max_memory = 0;
  settings.shutter = shutter_for(picture.shutter, parts.picture);
  const MotionRequest motion{settings.bounds, *settings.shutter, shutter_for(picture.before, parts.picture),
                             settings.threads};
  Rendering rendering = render_picture(parts, state_->plan, std::move(settings), observer);
  for (const auto& memory : state_->memories)
    if (memory) rendering.history_bytes += memory->bytes();
  if (state_->plan.motion) rendering.motion = motion_vectors(parts.scene, *parts.accel, motion);
  return rendering;
}

Result<Rendering> render_scene(const LoadedScene& scene, const RenderOptions& options, RenderObserver& observer) {
  Result<Plan> plan = plan_render(scene.parts(), options);
  if (!plan) return plan.failure();
  RenderSettings settings = plan->render;
  if (!options.checkpoint && !options.resume)
    return render_picture(scene.parts(), *plan, std::move(settings), observer);

  if (options.budget) return Failure{"a picture within a time budget is not saved, and continues no saved film"};
  SavedFilm film = description_of(scene.parts(), *plan, settings, options);
  if (options.resume) {
    if (Status good = check_continues(*options.resume, film); !good) return good.failure();
    settings.begun = &options.resume->begun;
  }
  Status saved{Done{}};
  if (options.checkpoint)
    settings.keeping = {options.checkpoint->every, [&](FilmSnapshot snapshot) {
                          snapshot.seconds += film.begun.seconds;
                          const bool was_saved(saved);
                          saved = save_snapshot(options.checkpoint->file, film, snapshot);
                          if (!saved && was_saved) observer.announce(saved.error());
                        }};
  Rendering rendering = render_picture(scene.parts(), *plan, std::move(settings), observer, &film);
  rendering.saved = saved;
  return rendering;
}

std::vector<std::string> missing_light_of(const LoadedScene& scene) {
  const LoadedScene::Parts& parts = scene.parts();
  const IntegratorDefaults defaults = integrator_defaults(parts.picture);
  std::vector<std::string> names;
  for (const MissingLight& light : missing_light(light_search(parts.picture.integrator), parts.scene, *parts.accel,
                                                 defaults.width, defaults.height))
    names.push_back(light.name);
  return names;
}

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

std::string version() { return std::string(montelux_version); }

Result<SampleTrace> trace_sample(const LoadedScene& scene, const RenderOptions& options, int x, int y,
                                 std::optional<int> sample) {
  const LoadedScene::Parts& parts = scene.parts();
  Result<Plan> planned = plan_render(parts, options);
  if (!planned) return planned.failure();
  const Plan& plan = *planned;
  const RenderSettings& r = plan.render;
  const PixelBounds& b = r.bounds;
  if (x < b.x0 || y < b.y0 || x >= b.x1 || y >= b.y1)
    return Failure{fmt::format("pixel {},{} is outside of the picture, whose pixels are {},{} to {},{}", x, y, b.x0,
                               b.y0, b.x1 - 1, b.y1 - 1)};
  const int in_pass = r.plan.samples_per_pass, all = in_pass * r.plan.passes;
  if (sample && (*sample < 0 || *sample >= all))
    return Failure{fmt::format("the pixel has samples 0 to {}; found {}", all - 1, *sample)};
  const auto trace = [&](int number) -> std::optional<TracedPath> {
    const PointSet points{r.sampler,
                          r.seed,
                          std::uint32_t(r.first_pass + number / in_pass),
                          std::uint32_t(in_pass),
                          std::uint32_t(r.width),
                          std::uint32_t(r.height)};
    TilePass pass{{x, y, x + 1, y + 1}, points, r.shutter};
    pass.only = std::uint32_t(number % in_pass);
    return plan.chosen.integrator ? plan.chosen.integrator->trace_path(pass) : std::nullopt;
  };
  if (!trace(0))
    return Failure{fmt::format("the integrator {} has no paths to show; path and naive have", plan.chosen.name)};
  SampleTrace result{
      x, y, 0, all, 0, 0, r.seed, {}, plan.chosen.name, std::string(name_of(r.sampler)), plan.chosen.notes, {}, {}, {}};
  std::array<double, spectrum_size> sum{};
  float largest = -1;
  for (int k = 0; k < all; ++k) {
    TracedPath path = *trace(k);
    for (int c = 0; c < spectrum_size; ++c) sum[std::size_t(c)] += double(path.radiance.c[c]);
    const bool brightest = std::abs(luminance(path.radiance)) > largest;
    if (sample ? k != *sample : !brightest) continue;
    largest = std::abs(luminance(path.radiance));
    result.sample = k, result.path = std::move(path);
  }
  for (int c = 0; c < spectrum_size; ++c) result.pixel_mean.c[c] = float(sum[std::size_t(c)] / all);
  result.pass = r.first_pass + result.sample / in_pass, result.index = result.sample % in_pass;
  result.materials = parts.info.materials_by_number;
  for (std::uint32_t i = 0; i < parts.scene.lights.count(); ++i)
    result.light_names.emplace_back(light_kind_names[std::size_t(parts.scene.lights.kind(LightId(i)))]);
  return result;
}

}  // namespace montelux
