#include "api/render_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/automatic.h"
#include "api/denoisers.h"
#include "api/shortcomings.h"
#include "integrator/direct/settings.h"
#include "render/shared_samples.h"
#include "render/target_plan.h"
#include "render/timed_plan.h"

namespace montelux {

namespace {

std::vector<std::string_view> views_of(const std::vector<std::pair<std::string, std::string>>& named) {
  std::vector<std::string_view> names;
  for (const auto& [name, description] : named) names.push_back(name);
  return names;
}

Result<const DirectPreset*> find_preset(const std::optional<std::string>& name) {
  if (!name) return nullptr;
  for (const DirectPreset& preset : direct_presets())
    if (preset.name == *name) return &preset;
  const auto names = preset_names();
  return unknown_name("preset", *name, views_of(names));
}

// The integrator whose samples show the bias of the chosen one: of an integrator whose pixels share no samples the same
// without a limit of depth and without a clamp; of another one `path`.
Result<ChosenIntegrator> unbiased_partner(const ChosenIntegrator& chosen, ChoiceText choice,
                                          const LoadedScene::Parts& parts) {
  if (!chosen.integrator) choice = {"path", {}};
  for (const std::string name : {"maxdepth", "maxcomponent"}) {
    const bool is_set =
        std::ranges::any_of(chosen.biases, [&](const std::string& bias) { return bias.starts_with(name + "="); });
    if (!is_set && chosen.integrator) continue;
    std::erase_if(choice.settings, [&](const auto& setting) { return setting.first == name; });
    choice.settings.emplace_back(name, "none");
  }
  auto partner = choose_integrator(choice, integrator_defaults(parts.picture), parts.scene, *parts.accel);
  if (!partner) return partner;
  const std::string biases = fmt::format("{}", fmt::join(chosen.biases, ", "));
  if (!partner->biases.empty() || !partner->integrator)
    return Failure{
        fmt::format("the bias of {} cannot be measured: only that of maxdepth and maxcomponent can, and that "
                    "of integrators whose pixels share samples",
                    biases)};
  note_light(*partner, parts);
  std::vector<std::string> unseen;
  for (const std::string& light : partner->missing)
    if (std::ranges::find(chosen.missing, light) == chosen.missing.end()) unseen.push_back(light);
  if (!unseen.empty())
    return Failure{fmt::format("the bias of {} cannot be measured: {}, which has none, misses {}", biases,
                               partner->name, fmt::join(unseen, ", "))};
  return partner;
}
Status plan_unbiased(const ChoiceText& choice, const LoadedScene::Parts& parts, const RenderOptions& options,
                     RenderPlan& plan) {
  if (options.checkpoint || options.resume)
    return Failure{"the bias of a film that is saved or resumed is not measured"};
  if (plan.chosen.biases.empty()) {
    plan.chosen.notes.push_back("the integrator has no bias to measure");
    return Done{};
  }
  auto partner = unbiased_partner(plan.chosen, choice, parts);
  if (!partner) return partner.failure();
  plan.unbiased = std::move(partner->integrator);
  plan.settings.unbiased = plan.unbiased.get();
  return Done{};
}

// The integrator, with what its images lack.
Status plan_integrator(const LoadedScene::Parts& parts, const RenderOptions& options, const DirectPreset* preset,
                       RenderPlan& plan) {
  const PictureSettings& picture = parts.picture;
  auto choice =
      parse_choice(options.integrator.value_or(preset ? std::string(preset->integrator) : picture.integrator));
  if (!choice) return choice.failure();
  choice->settings.insert(choice->settings.end(), options.settings.begin(), options.settings.end());
  *choice = with_present_names(*std::move(choice));
  const Stopwatch since_choice;
  if (choice->name == "auto") {
    if (Status good = plan_automatic(*choice, parts, options, plan); !good) return good;
  } else {
    plan.integrator_text = canonical_text(*choice);
    auto chosen = choose_integrator(*choice, integrator_defaults(picture), parts.scene, *parts.accel);
    if (!chosen) return chosen.failure();
    plan.chosen = *std::move(chosen);
  }
  note_light(plan.chosen, parts);
  if (options.measure_bias)
    if (Status good = plan_unbiased(*choice, parts, options, plan); !good) return good;
  plan.replaced = replaced_in(parts.info, options.integrator || preset, options.sampler.has_value());
  plan.preparation = since_choice.seconds();
  return Done{};
}

// The requested layers that exist for the scene.
Result<LayerPlan> plan_layers(const LayerRequest& request, const ChosenIntegrator& chosen, const Scene& scene) {
  if (!chosen.any().has_layers()) {
    const bool clamped =
        std::ranges::any_of(chosen.biases, [](const std::string& bias) { return bias.starts_with("maxcomponent="); });
    if (clamped)
      return Failure{
          "samples that are scaled down to maxcomponent have no layers; --set maxcomponent=none removes the limit"};
    return Failure{fmt::format("the integrator {} has no layers; {} have them", chosen.name,
                               listed(integrators_with(Ability::layers)))};
  }
  if (request.strategies && !chosen.can(Ability::strategies))
    return Failure{
        fmt::format("the integrator {} has no layers of strategies; {} have them, and metropolis with strategies=bdpt",
                    chosen.name, listed(integrators_with(Ability::strategies)))};
  LayerPlan plan;
  plan.bounces = request.bounces;
  plan.strategies = request.strategies, plan.alone = request.alone;
  plan.mergings = chosen.can(Ability::mergings);
  plan.light_groups = request.light_groups;
  plan.spread = request.errors;
  state_light_groups(plan, scene);
  if (plan.group_names.empty()) plan.group_names = {"default"};
  return plan;
}

// What is measured, except for the layers.
Status plan_image(const PictureSettings& picture, const RenderOptions& options, ChosenIntegrator& chosen,
                  ImageSettings& image) {
  image.sampler = picture.sampler;
  if (options.sampler) {
    auto kind = point_set_named(*options.sampler);
    const auto samplers = sampler_names();
    if (!kind) return unknown_name("sampler", *options.sampler, views_of(samplers));
    image.sampler = *kind;
  }
  if (is_fixed(image.sampler) && (options.budget || chosen.coupled))
    return Failure{fmt::format("sampler {} uses the same points in every pass, but {} needs different ones",
                               name_of(image.sampler), options.budget ? "a time budget" : chosen.name)};
  note_sampler(chosen, image.sampler);
  image.max_chance_radiance = chosen.max_chance_radiance;
  image.width = picture.width, image.height = picture.height;
  image.bounds = options.crop.value_or(picture.crop);
  const PixelBounds& b = image.bounds;
  if (b.x0 < 0 || b.y0 < 0 || b.x1 > image.width || b.y1 > image.height || b.x0 >= b.x1 || b.y0 >= b.y1)
    return Failure{fmt::format("the crop {},{},{},{} is not inside the picture of {} x {} pixels", b.x0, b.y0, b.x1,
                               b.y1, image.width, image.height)};
  image.seed = options.seed.value_or(picture.seed);
  if (options.shutter) image.shutter = shutter_for(*options.shutter, picture);
  return Done{};
}

// Passes with the requested number of samples, and of these the requested ones.
Status adjust_passes(const RenderOptions& options, const AnyIntegrator& integrator, PointSetKind sampler,
                     PassPlan& plan) {
  const int samples = plan.samples();
  if (const auto& k = options.samples_per_pass; k && *k != plan.samples_per_pass) {
    if (*k < 1 || *k > max_fixed_samples)
      return Failure{fmt::format("a pass has from 1 to {} samples per pixel; found {}", max_fixed_samples, *k)};
    // The passes of a saved film have a number of their own.
    const bool as_saved = options.resume && !options.samples;
    if (is_fixed(sampler) && !as_saved)
      return Failure{fmt::format("sampler {} takes all its samples in one pass, and has no others", name_of(sampler))};
    if (integrator.coupled() && *k > integrator.coupled()->frames())
      return Failure{fmt::format("a pass is a series of at most {} frames here; found {} samples a pass",
                                 integrator.coupled()->frames(), *k)};
    plan.samples_per_pass = *k, plan.passes = is_fixed(sampler) ? 1 : (samples + *k - 1) / *k;
  }
  if (options.resume && options.seconds && !is_fixed(sampler)) plan.passes = endless_passes;
  if (const auto& range = options.passes) {
    const bool further = options.resume && !options.samples;  // than the scene's number of samples
    if (!further && range->last >= plan.passes)
      return Failure{fmt::format("there is no pass {}: {} samples per pixel are {} passes of {}, from 0 to {}{}",
                                 range->last, samples, plan.passes, plan.samples_per_pass, plan.passes - 1,
                                 options.samples_per_pass ? "" : "; --samples-per-pass makes more of them")};
    plan.first_pass = range->first, plan.passes = range->count();
  }
  return Done{};
}

// Whether an error can be requested with these options.
Status check_target(const RenderOptions& options, PointSetKind sampler) {
  if (!options.target) return Done{};
  const ErrorTarget& target = options.target->error;
  if (!(target.error > 0 && target.error <= 1))
    return Failure{fmt::format("a requested error is above 0 and at most 1; found {}", target.error)};
  if (!(target.share >= 0.5 && target.share < 1))
    return Failure{
        fmt::format("the share of pixels within an error is from 0.5 to less than 1; found {}", target.share)};
  if (!(target.confidence >= 0.5 && target.confidence < 1))
    return Failure{fmt::format("a confidence is from 0.5 to less than 1; found {}", target.confidence)};
  if (is_fixed(sampler))
    return Failure{
        fmt::format("sampler {} uses the same points in every pass: its error is not known, and cannot be "
                    "requested",
                    name_of(sampler))};
  if (options.budget) return Failure{"a picture within a time budget has the error that the time allows"};
  if (options.preset) return Failure{"a preset has its own number of samples: it is not rendered to an error"};
  const bool continues_its_own = options.resume && options.target->unbiased && options.resume->options.target;
  if (options.passes && !continues_its_own)
    return Failure{"an error is that of all passes: a range of them is not rendered to an error"};
  if (options.resume && options.target->unbiased &&
      !(options.resume->options.target && options.resume->options.target->unbiased))
    return Failure{"an unbiased render decides its number of samples first: it does not continue a film of another"};
  return Done{};
}

// Whether tiles can have different numbers of passes with these options.
Status check_adaptive(const RenderOptions& options, const ChosenIntegrator& chosen, PointSetKind sampler) {
  const bool continues_adaptive = options.resume && options.resume->adaptive;
  if (continues_adaptive && !options.adaptive.value_or(false))
    return Failure{"the saved film is adaptive, and can only continue as such (--adaptive on)"};
  if (!options.adaptive.value_or(false)) return Done{};
  if (chosen.coupled)
    return Failure{
        fmt::format("the pixels of {} share samples: none of them can have more passes than others", chosen.name)};
  if (is_fixed(sampler))
    return Failure{
        fmt::format("sampler {} takes all its samples in one pass: no pixel can have more", name_of(sampler))};
  // The passes of a film that is continued begin with the first.
  if (options.budget || (options.passes && (!options.resume || options.passes->first != 0)))
    return Failure{"a range of passes and a time budget are the same for all pixels: they are not adaptive"};
  if (options.resume && !continues_adaptive)
    return Failure{
        "the saved film is not adaptive: all its tiles have the same passes, and so they do where it continues"};
  return Done{};
}

// Whether pixels share samples: by request, or where that lowers their errors more than it takes.
Status plan_sharing(const Scene& scene, const RenderOptions& options, RenderPlan& plan) {
  ImageSettings& image = plan.settings.image;
  const bool requested = options.shared_filters.value_or(false);
  if (requested && image.layers) return Failure{"pixels share no samples in images that have layers of light"};
  // The error that is left would be stated too small.
  if (requested && image.halves)
    return Failure{
        "pixels share no samples where noise is removed, or halves are written for that: it must be "
        "independent from pixel to pixel"};
  if (requested && plan.chosen.coupled)
    return Failure{
        fmt::format("the integrator {} traces all pixels together: these share no samples through their "
                    "filters",
                    plan.chosen.name)};
  if (requested && options.budget) return Failure{"pixels share no samples with --interactive-budget"};
  const bool allows = !image.layers && !image.halves && !options.budget && !scene.pixel_centres;
  if (!allows || !options.shared_filters.value_or(true)) return Done{};
  image.sharing = sharing_for(scene.filter);
  return Done{};
}

}  // namespace

std::string canonical_text(const ChoiceText& choice) {
  std::vector<std::string> settings;
  for (const auto& [key, value] : choice.settings) settings.push_back(fmt::format("{}={}", key, value));
  std::ranges::stable_sort(settings);
  return choice.name + (settings.empty() ? "" : ":") + fmt::format("{}", fmt::join(settings, ","));
}

Status plan_samples(const RenderOptions& options, int default_samples, RenderPlan& plan) {
  if (options.samples && (*options.samples < 1 || *options.samples > (1 << 24)))
    return Failure{fmt::format("the number of samples must be from 1 to {}; found {}", 1 << 24, *options.samples)};
  const PointSetKind sampler = plan.settings.image.sampler;
  if (Status good = check_target(options, sampler); !good) return good;
  if (Status good = check_adaptive(options, plan.chosen, sampler); !good) return good;
  const AnyIntegrator integrator = plan.chosen.any();
  if (options.target && options.samples) plan.max_samples = *options.samples;
  if (options.target && !options.samples) default_samples = int(max_film_samples);
  PassPlan& passes = plan.settings.plan;
  passes = options.budget ? plan_for_budget(integrator)
                          : plan_passes(integrator, options.samples.value_or(default_samples), sampler);
  if (Status good = adjust_passes(options, integrator, sampler, passes); !good) return good;
  if (is_fixed(sampler) && passes.samples_per_pass > max_fixed_samples)
    return Failure{fmt::format("sampler {} supports at most {} samples, all in one pass; found {}", name_of(sampler),
                               max_fixed_samples, passes.samples_per_pass)};
  return Done{};
}

bool RenderOptions::removes_noise() const {
  return denoise || denoiser || (target && target->error.measure == TargetMeasure::denoised);
}

std::optional<LayerRequest> RenderOptions::all_layers() const {
  if (!removes_noise()) return layers;
  LayerRequest all = layers.value_or(LayerRequest{});
  all.halves = true;
  return all;
}

Shutter shutter_for(const ShutterTimes& times, const PictureSettings& picture) {
  return shutter_of(times.open, times.close, picture.transforms_start, picture.transforms_end);
}

Result<RenderPlan> plan_render(const LoadedScene::Parts& parts, const RenderOptions& options) {
  if (options.budget && (options.seconds || options.samples || (options.layers && options.layers->of_light())))
    return Failure{"a time budget replaces the number of samples and the time, and does not support layers of light"};
  const auto preset = find_preset(options.preset);
  if (!preset) return preset.failure();
  RenderPlan plan;
  if (Status good = plan_integrator(parts, options, *preset, plan); !good) return good.failure();
  plan.motion = options.layers && options.layers->motion;
  plan.denoise = options.removes_noise();
  if (options.denoiser) {
    auto filter = parse_denoiser(*options.denoiser);
    if (!filter) return filter.failure();
    plan.filter = *std::move(filter);
  }
  plan.intervals = options.layers && options.layers->intervals;
  const std::optional<LayerRequest> layers_and_halves = options.all_layers();
  plan.settings.image.halves = layers_and_halves && layers_and_halves->halves;
  if (options.layers && options.layers->of_light()) {
    auto layers = plan_layers(*options.layers, plan.chosen, parts.scene);
    if (!layers) return layers.failure();
    plan.settings.image.layers = *std::move(layers);
  }
  if (Status good = plan_image(parts.picture, options, plan.chosen, plan.settings.image); !good) return good.failure();
  if (Status good = plan_sharing(parts.scene, options, plan); !good) return good.failure();
  const int samples = *preset ? (*preset)->eye_rays : parts.picture.samples;
  if (Status good = plan_samples(options, samples, plan); !good) return good.failure();
  plan.settings.threads = options.threads;
  plan.files = options.files, plan.samples_per_pass = options.samples_per_pass;
  plan.seconds = options.seconds, plan.budget = options.budget;
  plan.target = options.target, plan.adaptive = options.adaptive.value_or(false);
  if (plan.target) {
    plan.judged = std::make_shared<JudgedLayers>();
    plan.settings.target = judge_of(plan.target->error, options.threads, plan.judged, plan.filter);
    if (!plan.target->unbiased) plan.settings.work = std::make_shared<TargetPlan>(*plan.settings.target);
  }
  return plan;
}

PictureFacts facts_of(const LoadedScene::Parts& parts, const RenderPlan& plan, const RenderSettings& settings) {
  return {std::filesystem::path(parts.info.file).filename().string(),
          plan.chosen.name,
          std::string(name_of(settings.image.sampler)),
          settings.image.seed,
          settings.plan.samples_per_pass,
          plan.chosen.biases,
          plan.chosen.notes,
          plan.chosen.missing,
          parts.info.left_out,
          plan.replaced,
          plan.chosen.content,
          parts.info.states_exposure,
          filters_share_samples(settings.image, plan.chosen.any()),
          settings.image.layers,
          plan.target,
          plan.choice,
          settings.image.max_chance_radiance};
}

}  // namespace montelux
