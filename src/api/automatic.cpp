#include "api/automatic.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/shortcomings.h"
#include "integrator/automatic/settings.h"
#include "render/integrator_choice.h"
#include "render/timed_plan.h"

namespace montelux {

namespace {

// What options cannot be combined with a choice.
Status check_options(const RenderOptions& options, PointSetKind sampler) {
  if (options.budget)
    return Failure{"--integrator auto renders pilots first, which a time budget has no time for: state an integrator"};
  if (options.passes && !options.resume)
    return Failure{
        "--integrator auto chooses for a whole image, not for a range of its passes: state an integrator, the same for "
        "all ranges"};
  if (options.measure_bias)
    return Failure{"the bias of --integrator auto is that of the integrator that it chooses: state one to measure it"};
  if (is_fixed(sampler))
    return Failure{
        fmt::format("sampler {} uses the same points in every pass: the errors of integrators are not known, "
                    "and --integrator auto cannot choose",
                    name_of(sampler))};
  return Done{};
}

// Whether a setting is of the choice itself; others are of all candidates.
bool is_own(const Setting& setting) { return setting.first == "among" || setting.first == "share"; }

// A candidate with the settings that were stated for all.
ChoiceText with_common_settings(const std::string& text, const ChoiceText& automatic) {
  ChoiceText choice = parse_choice(text).value();
  for (const Setting& setting : automatic.settings) {
    const bool is_stated =
        std::ranges::any_of(choice.settings, [&](const Setting& s) { return s.first == setting.first; });
    if (!is_own(setting) && !is_stated) choice.settings.push_back(setting);
  }
  return choice;
}

bool contains_all(const std::vector<std::string>& all, const std::vector<std::string>& some) {
  return std::ranges::all_of(some, [&](const std::string& s) { return std::ranges::count(all, s) > 0; });
}

// Whether it estimates the same image as path, and can what the options require.
bool serves(const ChosenIntegrator& candidate, const ChosenIntegrator& path, const RenderOptions& options) {
  const bool by_pixels = options.adaptive.value_or(false) || (options.layers && options.layers->of_light());
  if (by_pixels && !candidate.integrator) return false;
  return candidate.biases == path.biases && contains_all(path.missing, candidate.missing) &&
         candidate.content == path.content;
}

// Samples of path that take as long as making the candidate; none where it has nothing to learn, and so does what path
// does.
std::optional<double> making_of(const AutomaticCandidate& candidate, const LightSet& lights) {
  double learning = 0;
  if (lights.infinite_count() > 0) learning += candidate.sky_making;
  if (lights.placed_count() >= several_lights || (lights.count() > 1 && lights.has_beyond()))
    learning += candidate.lights_making;
  const bool learns_lights = candidate.sky_making + candidate.lights_making > 0;
  if (learns_lights && learning + candidate.making == 0) return std::nullopt;
  return learning + candidate.making;
}

// A candidate, made when its first pilot begins.
struct Made {
  ChoiceText choice;
  std::optional<ChosenIntegrator> chosen;
};

std::string interval_text(const CandidateRatio& r) {
  return fmt::format("{:.2g} ({:.2g} to {:.2g})", r.ratio, r.low, r.high);
}

std::string reason_text(const std::string& name, const IntegratorChoice& choice, bool is_filtered) {
  const char* const after = is_filtered ? " after the removal of noise" : "";
  const auto best = choice.ratios.empty() ? CandidateRatio{} : choice.ratios.front();
  switch (choice.reason) {
    case ChoiceReason::single:
      return "no other integrator renders this image";
    case ChoiceReason::too_short:
      return "the render is too short for pilots";
    case ChoiceReason::none_better:
      return fmt::format("no other integrator is surely more efficient; {} is {} times as efficient{}{}", best.name,
                         interval_text(best), after,
                         best.is_unsure ? ", but few bright samples determine its error" : "");
    case ChoiceReason::better:
    case ChoiceReason::more_light:
      return fmt::format("{} times as efficient as path{}{}", interval_text(best), after,
                         choice.reason == ChoiceReason::more_light ? ", whose pilot lacks light that it found" : "");
    case ChoiceReason::interrupted:
      return "interrupted";
  }
  return name;
}

// Samples of path of every pixel that the render has time for. Takes about a hundredth of the time.
double affordable_samples(const RenderPlan& plan, RenderObserver& observer) {
  constexpr double part = 0.25;
  const TimedPlan timed = plan_for_time(plan.chosen.any(), plan.settings, TimeLimit(part * *plan.seconds), observer);
  return std::max(*plan.seconds / timed.sample_seconds, 1.0);
}

}  // namespace

Status plan_automatic(const ChoiceText& choice, const LoadedScene::Parts& parts, const RenderOptions& options,
                      RenderPlan& plan) {
  PointSetKind sampler = parts.picture.sampler;
  if (options.sampler) sampler = point_set_named(*options.sampler).value_or(sampler);
  if (Status good = check_options(options, sampler); !good) return good;
  const IntegratorDefaults defaults = integrator_defaults(parts.picture);
  if (options.resume) {
    auto stated = parse_choice(options.resume->settings.integrator);
    if (!stated) return stated.failure();
    auto chosen = choose_integrator(*stated, defaults, parts.scene, *parts.accel);
    if (!chosen) return chosen.failure();
    plan.chosen = *std::move(chosen), plan.integrator_text = canonical_text(*stated);
    plan.choice = options.resume->facts.choice;
    return Done{};
  }
  auto automatic = choose_integrator(choice, defaults, parts.scene, *parts.accel);
  if (!automatic) return automatic.failure();
  const ChoiceText path = with_common_settings("path", choice);
  auto chosen = choose_integrator(path, defaults, parts.scene, *parts.accel);
  if (!chosen) return chosen.failure();
  plan.chosen = *std::move(chosen), plan.integrator_text = canonical_text(path);
  plan.automatic = AutomaticPlan{choice, options};
  plan.automatic->options.resume = nullptr;
  return Done{};
}

Status choose_automatically(const LoadedScene::Parts& parts, RenderPlan& plan, RenderObserver& observer) {
  if (!plan.automatic) return Done{};
  const Stopwatch since_start;
  const AutomaticPlan automatic = *std::exchange(plan.automatic, std::nullopt);
  const IntegratorDefaults defaults = integrator_defaults(parts.picture);
  ChoiceText own = automatic.choice;
  std::erase_if(own.settings, [](const Setting& setting) { return !is_own(setting); });
  const auto list = read_settings(automatic_spec(), own.settings, "integrator");
  const auto settings = automatic_settings(list.value());

  std::vector<std::string> among = settings->among;
  if (among.empty())
    for (const AutomaticCandidate& candidate : automatic_candidates()) among.emplace_back(candidate.text);
  std::vector<Made> made;
  std::vector<Candidate> candidates{{"path", [&] { return plan.chosen.any(); }}};
  made.reserve(among.size());  // candidates refer to its elements
  for (const std::string& text : among) {
    const AutomaticCandidate costs = automatic_candidate(text);
    const std::optional<double> making = making_of(costs, parts.scene.lights);
    if (!making) continue;
    Made one{with_common_settings(text, automatic.choice), {}};
    const bool is_path = one.choice.name == "path";
    if (!is_path) {
      // One that cannot render the scene is no candidate.
      auto chosen = choose_integrator(one.choice, defaults, parts.scene, *parts.accel);
      if (!chosen || !serves(*chosen, plan.chosen, automatic.options)) continue;
      one.chosen = *std::move(chosen);
    }
    made.push_back(std::move(one));
    Made& kept = made.back();
    candidates.push_back({text,
                          [&kept, &parts, defaults] {
                            if (!kept.chosen)
                              kept.chosen = choose_integrator(kept.choice, defaults, parts.scene, *parts.accel).value();
                            return kept.chosen->any();
                          },
                          costs.ray_cost, costs.sample_cost, *making, kept.chosen && kept.chosen->any().splats()});
  }

  ChoiceSettings by{plan.settings.image, double(plan.settings.plan.samples()), {}};
  by.share = double(settings->share), by.threads = plan.settings.threads;
  // The error that counts is that of the request, if there is one.
  by.is_filtered = plan.target ? plan.target->error.measure == TargetMeasure::denoised : plan.denoise;
  if (plan.target) by.target = plan.target->error, by.samples = plan.max_samples;
  if (plan.seconds && candidates.size() > 1) {
    const double affordable = affordable_samples(plan, observer);
    by.samples = plan.target ? std::min(by.samples, affordable) : affordable;
  }
  const IntegratorChoice choice = choose_by_pilots(candidates, by, observer);
  std::string name = "path";
  if (choice.chosen > 0) {
    Made& best = made[choice.chosen - 1];
    name = candidates[choice.chosen].name;
    plan.chosen = std::move(*best.chosen), plan.integrator_text = canonical_text(best.choice);
    note_light(plan.chosen, parts);
    plan.settings.image.max_chance_radiance = plan.chosen.max_chance_radiance;
    plan.settings.plan = {};
    if (Status good = plan_samples(automatic.options, parts.picture.samples, plan); !good) return good;
  }
  plan.choice = AutomaticChoice{name, reason_text(name, choice, by.is_filtered), choice.share, {}};
  for (const CandidateRatio& r : choice.ratios) plan.choice->ratios.push_back({r.name, r.ratio, r.low, r.high});
  plan.preparation += since_start.seconds();
  if (choice.reason != ChoiceReason::interrupted) observer.announce("auto: " + to_text(*plan.choice));
  return Done{};
}

std::string to_text(const AutomaticChoice& choice) {
  std::string text = fmt::format("{}: {}", choice.integrator, choice.reason);
  if (choice.share > 0) text += fmt::format("; pilots took {:.1f} % of the work", 100 * choice.share);
  return text;
}

}  // namespace montelux
