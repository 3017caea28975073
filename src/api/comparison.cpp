#include "api/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "api/comparison_meter.h"
#include "api/comparison_methods.h"
#include "api/comparison_reference.h"
#include "lab/compare/pilot.h"
#include "render/shared_samples.h"

namespace montelux {

namespace {

Result<lab::ComparisonSettings> settings_of(const LoadedScene::Parts& parts, const ComparisonOptions& options) {
  lab::ComparisonSettings settings;
  ImageSettings& r = settings.render.image;
  r.width = parts.picture.width, r.height = parts.picture.height;
  r.bounds = options.crop.value_or(parts.picture.crop);
  const PixelBounds& b = r.bounds;
  if (b.x0 < 0 || b.y0 < 0 || b.x1 > r.width || b.y1 > r.height || b.x0 >= b.x1 || b.y0 >= b.y1)
    return Failure{fmt::format("the crop is not inside the picture of {} x {} pixels", r.width, r.height)};
  r.seed = options.seed;
  if (!parts.scene.pixel_centres) r.sharing = sharing_for(parts.scene.filter);
  settings.render.threads = options.threads;
  settings.warm_up_counts = !options.warm_frames;
  if (options.processor_time) settings.render.clock = processor_seconds;
  settings.slopes = options.slopes;
  settings.seconds = options.seconds;
  settings.samples = options.samples.value_or(settings.samples);
  settings.repeats = options.repeats;
  settings.confidence = options.confidence;
  settings.measure = options.measure;
  return settings;
}

std::string listed(const std::vector<std::string>& names) {
  return montelux::listed(std::vector<std::string_view>(names.begin(), names.end()));
}

// Why there is no verdict; empty if there is one.
std::string refusal_of(const lab::ComparisonResult& result) {
  const double share = result.reference_share[result.measure];
  if (share <= largest_reference_share) return {};
  if (!std::isfinite(share))
    return "the noise of the reference explains the errors of all methods: it needs many times more samples";
  return fmt::format(
      "the variance of the reference is {:.0f} % of the smallest error (limit {:.0f} %): it would decide the "
      "comparison; it needs {:.1f} times as many samples",
      100 * share, 100 * largest_reference_share, share / largest_reference_share);
}

// What the user must know about the methods: one note for all that share it.
std::vector<std::string> notes_of_methods(const Field& field, bool attribution) {
  std::map<std::string, std::vector<std::string>> by_bias, by_light;
  std::vector<std::string> unlayered, notes;
  for (std::size_t i = 0; i < field.compared_methods.size(); ++i) {
    const lab::ComparedMethod& c = field.compared_methods[i];
    if (!c.biases.empty()) by_bias[fmt::format("{}", fmt::join(c.biases, ", "))].push_back(c.shown_name());
    for (const std::string& light : field.shortcomings[i].missing) by_light[light].push_back(c.shown_name());
    if (attribution && !c.layers) unlayered.push_back(c.shown_name());
  }
  for (const auto& [bias, names] : by_bias)
    notes.push_back(fmt::format("{} {} biased: {}", listed(names), names.size() > 1 ? "are" : "is", bias));
  for (const auto& [light, names] : by_light)
    notes.push_back(fmt::format("{} cannot find {}: it is missing from {}, and from a reference rendered {}",
                                listed(names), light, names.size() > 1 ? "their pictures" : "its pictures",
                                names.size() > 1 ? "by one of them" : "by it"));
  if (!unlayered.empty())
    notes.push_back(fmt::format("the variance of {} is not attributed, since {} not split light into layers",
                                listed(unlayered), unlayered.size() > 1 ? "they do" : "it does"));
  return notes;
}

// Computes results and notes once all rounds are done.
void conclude(const LoadedScene::Parts& parts, const Field& field, const lab::ComparisonSettings& settings,
              bool interrupted, Comparison& comparison) {
  comparison.result = lab::result_of(field.compared_methods, comparison.saved.state, settings);
  comparison.result.interrupted = interrupted;
  comparison.notes = comparison.saved.notes;
  comparison.shortcomings = field.shortcomings, comparison.left_out = parts.info.left_out;
  comparison.refusal = refusal_of(comparison.result);
  const auto notes = notes_of_methods(field, comparison.saved.options.attribution);
  comparison.notes.insert(comparison.notes.end(), notes.begin(), notes.end());
}

// Excluded warm-up frames must exist.
Status check_warm_up(const std::vector<lab::ComparedMethod>& compared_methods, const ComparisonOptions& options) {
  const auto warms_up = [](const lab::ComparedMethod& c) {
    return c.integrator.coupled() && c.integrator.coupled()->warm_up() > 0;
  };
  if (!options.warm_frames || std::ranges::any_of(compared_methods, warms_up)) return Done{};
  return Failure{"no method has warm-up frames; for example restir-di:frames=1,warm-up=12 has"};
}

// Seconds of one repeat of one method; none if unknown.
std::optional<double> seconds_of_repeat(const lab::ComparisonState& state, const lab::ComparisonSettings& settings) {
  if (settings.seconds) return *settings.seconds / settings.repeats;
  double sum = 0, repeats = 0;
  for (const lab::MethodState& m : state.methods)
    for (const lab::Repeat& r : m.repeats) sum += r.seconds, repeats += 1;
  if (!(sum > 0)) return std::nullopt;
  return sum / repeats;
}

// The expected time of all rounds together; each method contributes its share.
double expect_repeats(const Field& field, const lab::ComparisonSettings& settings, int rounds,
                      const std::vector<double>& sample_seconds, lab::ComparisonState& state) {
  double all = 0;
  for (std::size_t i = 0; i < field.compared_methods.size(); ++i) {
    lab::MethodState& method = state.methods[i];
    method.repeat_seconds =
        lab::expected_repeat_seconds(field.compared_methods[i], settings, method.plan, sample_seconds[i]);
    all += rounds * method.repeat_seconds;
  }
  return all;
}

// The expected number of samples per pixel in one repeat of each method.
std::vector<double> samples_of_repeats(const lab::ComparisonState& state, const lab::ComparisonSettings& settings,
                                       const std::vector<double>& sample_seconds) {
  std::vector<double> samples;
  for (std::size_t i = 0; i < state.methods.size(); ++i)
    samples.push_back(settings.seconds ? std::max(*settings.seconds / settings.repeats / sample_seconds[i], 1.0)
                                       : double(state.methods[i].plan.samples()));
  return samples;
}

// The state that the parts of one comparison share.
struct Work {
  const LoadedScene::Parts& parts;
  const Field& field;
  const lab::ComparisonSettings& settings;
  const ComparisonObserver& observer;
  ComparisonMeter& meter;
};

// A reference better than the goal: from the cache, or rendered now.
void take_reference(const Work& work, const lab::ReferenceGoal& goal, Comparison& comparison) {
  const PixelBounds& bounds = work.settings.render.image.bounds;
  const auto file = comparison.saved.options.cache
                        ? reference_cache(work.parts, bounds, work.field.compared_methods[goal.method])
                        : std::nullopt;
  auto kept = file ? kept_reference(*file, bounds, goal.variance) : std::nullopt;
  if (!kept) comparison.forecast.reference = goal.seconds;
  work.meter.expect(comparison.forecast.reference + comparison.forecast.repeats);
  if (work.observer.forecast) work.observer.forecast(comparison.forecast);
  if (kept) {
    comparison.saved.notes.push_back("the reference was stored by an earlier comparison: " + file->string());
    comparison.saved.state.reference = *std::move(kept);
    return;
  }
  comparison.saved.state.reference =
      lab::make_reference(work.field.compared_methods, goal, work.settings, work.meter.watch());
  if (file && !work.meter.watch().stopped()) keep_reference(*file, comparison.saved.state.reference);
}

// Pilots and reference, with the predicted times; false if it was stopped before there was a reference.
bool prepare(const Work& work, ReferenceSource source, Comparison& comparison) {
  lab::ComparisonState& state = comparison.saved.state;
  const auto& compared_methods = work.field.compared_methods;
  const int rounds = work.settings.repeats;
  state = lab::begin_comparison(compared_methods, {}, work.settings);
  std::vector<double> seconds = lab::time_methods(compared_methods, state, work.settings, work.meter.watch());
  comparison.forecast.repeats = expect_repeats(work.field, work.settings, rounds, seconds, state);
  if (source.reference) {
    state.reference = *std::move(source.reference);
    comparison.forecast.pilots = work.meter.elapsed();
    work.meter.expect(comparison.forecast.repeats);
    if (work.observer.forecast) work.observer.forecast(comparison.forecast);
    return true;
  }
  // Before the pilots: a pilot takes as long as a repeat without its slopes, a reference about twenty times that.
  const double one_repeat = comparison.forecast.repeats / rounds / double(compared_methods.size());
  work.meter.expect(comparison.forecast.repeats + one_repeat * (0.5 * double(compared_methods.size()) + 10));
  const std::vector<lab::Pilot> pilots =
      lab::run_pilots(compared_methods, state, seconds, work.settings, work.meter.watch());
  if (work.meter.watch().stopped()) return false;
  for (std::size_t i = 0; i < pilots.size(); ++i) seconds[i] = pilots[i].wall_seconds / pilots[i].samples;
  comparison.forecast.pilots = work.meter.elapsed();
  comparison.forecast.repeats = expect_repeats(work.field, work.settings, rounds, seconds, state);
  constexpr double wanted_share = 0.05;
  take_reference(work,
                 lab::plan_reference(pilots, source.may_serve, samples_of_repeats(state, work.settings, seconds),
                                     work.settings.measure, wanted_share),
                 comparison);
  return !work.meter.watch().stopped();
}

// Checks that the saved state fits the current scene.
Status check_fit(const SavedComparison& saved, const Field& field, const PixelBounds& b) {
  if (saved.state.reference.mean.width != b.width() || saved.state.reference.mean.height != b.height() ||
      saved.state.methods.size() != field.compared_methods.size())
    return Failure{"the saved comparison does not fit the scene: it has other sizes"};
  for (std::size_t i = 0; i < field.compared_methods.size(); ++i) {
    const auto& layers = field.compared_methods[i].layers;
    const auto& shares = saved.state.methods[i].pixel_shares;
    if (!shares.empty() && (!layers || shares.size() != std::size_t(layers->count()) + 1))
      return Failure{"the saved comparison does not fit the scene: its variance was attributed to other layers"};
  }
  return Done{};
}

}  // namespace

Status check_methods(const ComparisonOptions& options) {
  if (auto methods = read_methods(options); !methods) return methods.failure();
  return Done{};
}

Result<Comparison> compare_methods(const LoadedScene& scene, const ComparisonOptions& typed,
                                   const ComparisonObserver& observer) {
  ComparisonMeter meter(observer);
  const auto chosen = choose_methods(scene.parts(), typed, observer);
  if (!chosen) return chosen.failure();
  const ComparisonOptions& options = chosen->options;
  auto field = make_field(scene.parts(), options);
  if (!field) return field.failure();
  if (Status warm = check_warm_up(field->compared_methods, options); !warm) return warm.failure();
  auto settings = settings_of(scene.parts(), options);
  if (!settings) return settings.failure();
  auto source = find_reference(options, field->compared_methods, settings->render.image.bounds);
  if (!source) return source.failure();
  Comparison comparison;
  comparison.saved.options = options, comparison.saved.notes = chosen->notes;
  const Work work{scene.parts(), *field, *settings, observer, meter};
  if (!prepare(work, *std::move(source), comparison))
    return Failure{"interrupted before there was a reference to compare with"};
  const bool whole =
      lab::run_rounds(field->compared_methods, *settings, settings->repeats, meter.watch(), comparison.saved.state);
  conclude(scene.parts(), *field, *settings, !whole, comparison);
  comparison.seconds = meter.elapsed();
  return comparison;
}

Result<Comparison> continue_comparison(const LoadedScene& scene, SavedComparison saved, const ComparisonBudget& more,
                                       const ComparisonObserver& observer) {
  ComparisonMeter meter(observer);
  auto field = make_field(scene.parts(), saved.options);
  if (!field) return field.failure();
  auto settings = settings_of(scene.parts(), saved.options);
  if (!settings) return settings.failure();
  if (Status fits = check_fit(saved, *field, settings->render.image.bounds); !fits) return fits.failure();
  int rounds = more.repeats.value_or(settings->repeats);
  if (more.seconds) {
    const std::optional<double> one = seconds_of_repeat(saved.state, *settings);
    if (!one)
      return Failure{
          "the saved comparison has no finished repeat, so its duration is unknown: use --repeats instead of --time"};
    rounds = int(std::clamp(std::round(*more.seconds / *one), 1.0, 1e6));
  }
  Comparison comparison;
  comparison.saved = std::move(saved);
  const std::vector<double> seconds =
      lab::time_methods(field->compared_methods, comparison.saved.state, *settings, meter.watch());
  comparison.forecast.repeats = expect_repeats(*field, *settings, rounds, seconds, comparison.saved.state);
  meter.expect(comparison.forecast.repeats);
  if (observer.forecast) observer.forecast(comparison.forecast);
  const bool whole = lab::run_rounds(field->compared_methods, *settings, rounds, meter.watch(), comparison.saved.state);
  conclude(scene.parts(), *field, *settings, !whole, comparison);
  comparison.seconds = meter.elapsed();
  return comparison;
}

}  // namespace montelux
