#include "api/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "api/parts.h"
#include "api/shortcomings.h"
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

// The layers that a scene has of those that were asked for.
Result<LayerPlan> plan_layers(const LayerRequest& request, const ChosenIntegrator& chosen, const Scene& scene) {
  if (!chosen.integrator || !chosen.integrator->has_layers()) {
    const bool clamped =
        std::ranges::any_of(chosen.biases, [](const std::string& bias) { return bias.starts_with("maxcomponent="); });
    if (clamped)
      return Failure{
          "samples that are scaled down to maxcomponent have no layers; --set maxcomponent=none lifts the bound"};
    return Failure{
        fmt::format("the integrator {} has no layers; path, naive, direct and distribution have them", chosen.name)};
  }
  LayerPlan plan;
  plan.bounces = request.bounces;
  plan.light_groups = request.light_groups;
  plan.spread = request.errors;
  plan.group_of_light = scene.lights.groups();
  plan.group_names = scene.lights.group_names();
  if (plan.group_names.empty()) plan.group_names = {"default"};
  return plan;
}

// Everything that decides a render, checked.
struct Plan {
  RenderSettings render;
  ChosenIntegrator chosen;
  std::vector<Replacement> replaced;
  FilesToWrite files;
  bool motion = false;     // of a sequence
  double preparation = 0;  // seconds that the making of the integrator took: pilots, meshes of elements
};

Shutter shutter_for(const ShutterTimes& times, const PictureSettings& picture) {
  return shutter_of(times.open, times.close, picture.transforms_start, picture.transforms_end);
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
    return Failure{fmt::format("sampler {} takes the same points in every pass, and {} needs others in each",
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
  plan.files = options.files;
  if (options.budget && (options.seconds || options.samples || plan.render.layers))
    return Failure{"a time budget takes the place of a number of samples and of a time, and has no layers of light"};
  if (options.budget) r.budget = {*options.budget, 0};
  r.plan = options.budget
               ? plan_for_budget(plan.chosen.any())
               : plan_passes(plan.chosen.any(), options.samples.value_or(preset ? preset->eye_rays : picture.samples),
                             r.sampler);
  if (is_fixed(r.sampler) && r.plan.samples_per_pass > most_fixed_samples)
    return Failure{fmt::format("sampler {} takes at most {} samples, all in one pass; found {}", name_of(r.sampler),
                               most_fixed_samples, r.plan.samples_per_pass)};
  return plan;
}

// What one picture was rendered with.
struct PicturePlan {
  const Plan& plan;
  const RenderSettings& render;
  const ImageEstimate& image;
  const ErrorEstimate& error;
  bool found_no_light = false;
};

// For a header, which has no lists.
std::string list_or_none(const std::vector<std::string>& all, std::string_view separator = "; ") {
  return all.empty() ? std::string("none") : fmt::format("{}", fmt::join(all, separator));
}

// What a picture is called of which only one pixel in each square of pixels is sampled.
std::string sparse_text(int stride) {
  return fmt::format("one pixel of each {0} x {0} is sampled, the others repeat it", stride);
}

// The plan within the time that is left: the making of the integrator has taken `before`, which grows by what this
// takes, and in the end the picture is written.
void plan_timed(const AnyIntegrator& integrator, const FilesToWrite& files, RenderSettings& settings, double& before,
                RenderObserver& observer) {
  // Of the time, what is rendered in however long the rest takes.
  constexpr double min_share = 0.1;
  const double all = *settings.seconds;
  const Stopwatch since_start;
  const auto left = [&](double end) { return std::max(end - before - since_start.seconds(), min_share * all); };
  const FinishTime finish = seconds_to_finish(settings.bounds, files);
  const double end = all - finish.error - finish.encoding;
  if (left(all - finish.encoding) == min_share * all)
    observer.announce(
        fmt::format("to prepare and to write the picture takes about {:.2g} s of its own, in addition to the time",
                    before + finish.encoding));
  const TimedPlan timed = plan_for_time(integrator, settings, left(end), observer);
  settings.plan = timed.plan, settings.stride = timed.stride, settings.max_unit_samples = timed.max_unit_samples;
  if (timed.stride > 1)
    observer.announce(fmt::format("one sample of every pixel takes about {:.2g} s, more than the time: {}",
                                  timed.sample_seconds, sparse_text(timed.stride)));
  else if (integrator.coupled() && timed.sample_seconds > left(end))
    observer.announce(fmt::format("one frame takes about {:.2g} s, more than the time: the picture is one frame",
                                  timed.sample_seconds));
  // The error of a sparse picture is not estimated.
  settings.seconds = left(timed.stride > 1 ? all - finish.encoding : end);
  before += since_start.seconds();
}

// Whether there are samples and each of them is zero. (A mean of zero of values that are not shows in m2.)
bool is_black(const Film& film) {
  const PixelBounds& b = film.bounds();
  bool sampled = false;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      const PixelEstimate& pixel = film.pixel(x, y);
      sampled |= pixel.passes > 0;
      for (int c = 0; c < spectrum_size; ++c)
        if (pixel.mean[c] != 0 || pixel.m2[c] != 0) return false;
    }
  return sampled;
}

std::vector<Attribute> header_of(const LoadedScene::Parts& parts, const PicturePlan& picture,
                                 const RenderResult& result) {
  std::vector<Attribute> header;
  auto add = [&](std::string name, std::variant<std::string, std::int32_t, float, double> value) {
    header.push_back({"montelux:" + std::move(name), std::move(value)});
  };
  add("version", version());
  add("scene", std::filesystem::path(parts.info.file).filename().string());
  add("integrator", picture.plan.chosen.name);
  add("sampler", std::string(name_of(picture.render.sampler)));
  add("seed", std::int32_t(picture.render.seed));
  add("samplesPerPass", std::int32_t(picture.render.plan.samples_per_pass));
  const ImageEstimate& image = picture.image;
  add("passes", std::int32_t(image.passes));
  add("nonFinite", std::int32_t(std::min<std::uint64_t>(result.film.non_finite(), 0x7fffffff)));
  add("biasedOptions", list_or_none(picture.plan.chosen.biases, ", "));
  add("display", std::string(content_names[std::size_t(picture.plan.chosen.content)]));
  add("exposure", std::string(parts.info.states_exposure ? "stated by the scene" : "not stated"));
  add("missingLight", list_or_none(picture.plan.chosen.missing));
  std::vector<std::string> replaced;
  for (const Replacement& r : picture.plan.replaced) replaced.push_back(to_text(r));
  add("replaced", list_or_none(replaced));
  add("leftOut", list_or_none(parts.info.left_out));
  const bool has_error_bar = image.passes >= 2 && !picture.found_no_light;
  if (has_error_bar)
    add("errorBar", fmt::format("over {} independent passes", image.passes));
  else
    add("errorBar",
        std::string(picture.found_no_light ? "none: no sample found light" : "none: it takes two independent passes"));
  if (result.film.grid().stride > 1) add("sparse", sparse_text(result.film.grid().stride));
  if (const ErrorEstimate& error = picture.error; error.whole() && !picture.found_no_light) {
    add("estimatedMSE", error.mse);
    add("estimatedRelativeMSE", error.relative_mse);
    add("estimatedRelativeMSELow", error.relative_low);
    add("estimatedRelativeMSEHigh", error.relative_high);
    if (error.is_unsure()) add("unsureError", std::string("few bright samples decide the error"));
  }
  for (int c = 0; c < spectrum_size; ++c) {
    add(fmt::format("mean{}", "RGB"[c]), image.mean[c]);
    if (has_error_bar) add(fmt::format("meanStandardError{}", "RGB"[c]), image.standard_error[c]);
  }
  // A file that must be the same in every run carries no times.
  if (auto date = date_attribute())
    header.push_back(*date);
  else
    add("renderSeconds", result.seconds);
  return header;
}

// One picture, as the plan is but for seed, shutter and memories. What the end of a picture takes goes into the plan.
Rendering render_picture(const LoadedScene::Parts& parts, Plan& plan, RenderSettings settings,
                         RenderObserver& observer) {
  const AnyIntegrator integrator = plan.chosen.any();
  // The integrator is made once, and that counts for the first picture of a sequence.
  double before = std::exchange(plan.preparation, 0.0);
  if (settings.seconds) {
    // The time includes the making of the integrator, the measurement of its speed, and the writing of the picture.
    plan_timed(integrator, plan.files, settings, before, observer);
  }
  if (settings.budget) settings.budget->seconds -= before;
  RenderResult result = render(integrator, settings, observer);
  result.seconds += before;
  const ImageEstimate image = result.film.image();
  const ErrorEstimate error = result.film.error();
  if (settings.budget) {
    const PixelBounds& b = settings.bounds;
    const int passes = std::max(image.passes, 1);
    settings.plan = {int(result.film.samples(b.x0, b.y0)) / passes, passes};
    plan.render.budget->ending = result.ending;
  }
  const bool found_no_light = plan.chosen.content == Content::light && is_black(result.film);
  std::vector<Attribute> header = header_of(parts, {plan, settings, image, error, found_no_light}, result);
  return Rendering{std::move(result),
                   std::move(header),
                   plan.chosen.notes,
                   settings.plan,
                   settings.layers,
                   0,
                   {},
                   image,
                   error,
                   plan.chosen.missing,
                   plan.replaced,
                   parts.info.left_out,
                   plan.chosen.content,
                   parts.info.states_exposure,
                   found_no_light};
}

}  // namespace

std::optional<Interval> Rendering::interval_of_mean(int channel, double confidence) const {
  if (!has_error_bar()) return std::nullopt;
  return confidence_interval(image.mean[channel], image.standard_error[channel], image.passes, confidence);
}

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
  if (picture.is_last) settings.most_memory = 0;
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
  return render_picture(scene.parts(), *plan, std::move(settings), observer);
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

}  // namespace montelux
