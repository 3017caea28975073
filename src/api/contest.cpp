#include "api/contest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "api/contest_meter.h"
#include "api/contest_methods.h"
#include "api/contest_reference.h"
#include "lab/compare/pilot.h"

namespace montelux {

namespace {

Result<lab::ContestSettings> settings_of(const LoadedScene::Parts& parts, const ContestOptions& options) {
  lab::ContestSettings settings;
  RenderSettings& r = settings.render;
  r.width = parts.picture.width, r.height = parts.picture.height;
  r.bounds = options.crop.value_or(parts.picture.crop);
  const PixelBounds& b = r.bounds;
  if (b.x0 < 0 || b.y0 < 0 || b.x1 > r.width || b.y1 > r.height || b.x0 >= b.x1 || b.y0 >= b.y1)
    return Failure{fmt::format("the crop is not inside the picture of {} x {} pixels", r.width, r.height)};
  r.seed = options.seed, r.threads = options.threads;
  r.warm_up_counts = !options.warm_frames;
  if (options.processor_time) r.clock = processor_seconds;
  settings.slopes = options.slopes;
  settings.seconds = options.seconds;
  settings.samples = options.samples.value_or(settings.samples);
  settings.repeats = options.repeats;
  settings.confidence = options.confidence;
  settings.measure = options.measure;
  return settings;
}

// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& names) {
  if (names.size() < 2) return names.empty() ? "" : names.front();
  return fmt::format("{} and {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
}

// Why the verdicts do not count; empty where they do.
std::string refusal_of(const lab::ContestResult& result) {
  const double share = result.reference_share[result.measure];
  if (share <= largest_reference_share) return {};
  if (!std::isfinite(share))
    return "the noise of the reference explains the errors of all methods: it needs many times more samples";
  return fmt::format(
      "the variance of the reference is {:.0f} % of the smallest error (limit {:.0f} %): it would decide the "
      "comparison; it needs {:.1f} times as many samples",
      100 * share, 100 * largest_reference_share, share / largest_reference_share);
}

// What the reader must know of the methods: one note for all that are alike.
std::vector<std::string> notes_of_methods(const Field& field, bool attribution) {
  std::map<std::string, std::vector<std::string>> by_bias, by_light;
  std::vector<std::string> unlayered, notes;
  for (std::size_t i = 0; i < field.contestants.size(); ++i) {
    const lab::Contestant& c = field.contestants[i];
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

// What is to be said once all rounds are done.
void conclude(const LoadedScene::Parts& parts, const Field& field, const lab::ContestSettings& settings,
              bool interrupted, Contest& contest) {
  contest.result = lab::result_of(field.contestants, contest.saved.state, settings);
  contest.result.interrupted = interrupted;
  contest.notes = contest.saved.notes;
  contest.shortcomings = field.shortcomings, contest.left_out = parts.info.left_out;
  contest.refusal = refusal_of(contest.result);
  const auto notes = notes_of_methods(field, contest.saved.options.attribution);
  contest.notes.insert(contest.notes.end(), notes.begin(), notes.end());
}

// Frames that are not to count must be there.
Status check_warm_up(const std::vector<lab::Contestant>& contestants, const ContestOptions& options) {
  const auto warms_up = [](const lab::Contestant& c) {
    return c.integrator.coupled() && c.integrator.coupled()->warm_up() > 0;
  };
  if (!options.warm_frames || std::ranges::any_of(contestants, warms_up)) return Done{};
  return Failure{"no method has warm-up frames; for example restir-di:chain=1,warm-up=12 has"};
}

// Seconds of one repeat of one method; none where that is not known.
std::optional<double> seconds_of_repeat(const lab::ContestState& state, const lab::ContestSettings& settings) {
  if (settings.seconds) return *settings.seconds / settings.repeats;
  double sum = 0, repeats = 0;
  for (const lab::MethodState& m : state.methods)
    for (const lab::Repeat& r : m.repeats) sum += r.seconds, repeats += 1;
  if (!(sum > 0)) return std::nullopt;
  return sum / repeats;
}

// How long all rounds together are expected to take; a method reports its share of the whole.
double expect_repeats(const Field& field, const lab::ContestSettings& settings, int rounds,
                      const std::vector<double>& sample_seconds, lab::ContestState& state) {
  double all = 0;
  for (std::size_t i = 0; i < field.contestants.size(); ++i) {
    lab::MethodState& method = state.methods[i];
    method.repeat_seconds =
        lab::expected_repeat_seconds(field.contestants[i], settings, method.plan, sample_seconds[i]);
    all += rounds * method.repeat_seconds;
  }
  return all;
}

// Samples a pixel that one repeat of each method is expected to have.
std::vector<double> samples_of_repeats(const lab::ContestState& state, const lab::ContestSettings& settings,
                                       const std::vector<double>& sample_seconds) {
  std::vector<double> samples;
  for (std::size_t i = 0; i < state.methods.size(); ++i)
    samples.push_back(settings.seconds ? std::max(*settings.seconds / settings.repeats / sample_seconds[i], 1.0)
                                       : double(state.methods[i].plan.samples()));
  return samples;
}

// What the parts of one comparison work on.
struct Work {
  const LoadedScene::Parts& parts;
  const Field& field;
  const lab::ContestSettings& settings;
  const ContestObserver& observer;
  ContestMeter& meter;
};

// The reference that is better than the goal: kept from before, or made now.
void take_reference(const Work& work, const lab::ReferenceGoal& goal, Contest& contest) {
  const PixelBounds& bounds = work.settings.render.bounds;
  const auto file = contest.saved.options.cache
                        ? reference_cache(work.parts, bounds, work.field.contestants[goal.method])
                        : std::nullopt;
  auto kept = file ? kept_reference(*file, bounds, goal.variance) : std::nullopt;
  if (!kept) contest.forecast.reference = goal.seconds;
  work.meter.expect(contest.forecast.reference + contest.forecast.repeats);
  if (work.observer.forecast) work.observer.forecast(contest.forecast);
  if (kept) {
    contest.saved.notes.push_back("the reference was stored by an earlier comparison: " + file->string());
    contest.saved.state.reference = *std::move(kept);
    return;
  }
  contest.saved.state.reference = lab::make_reference(work.field.contestants, goal, work.settings, work.meter.watch());
  if (file && !work.meter.watch().stopped()) keep_reference(*file, contest.saved.state.reference);
}

// Pilots and reference, with what all is expected to take; false where it was stopped before there was a reference.
bool prepare(const Work& work, ReferenceSource source, Contest& contest) {
  lab::ContestState& state = contest.saved.state;
  const auto& contestants = work.field.contestants;
  const int rounds = work.settings.repeats;
  state = lab::begin_contest(contestants, {}, work.settings);
  std::vector<double> seconds = lab::time_methods(contestants, state, work.settings, work.meter.watch());
  contest.forecast.repeats = expect_repeats(work.field, work.settings, rounds, seconds, state);
  if (source.reference) {
    state.reference = *std::move(source.reference);
    contest.forecast.pilots = work.meter.elapsed();
    work.meter.expect(contest.forecast.repeats);
    if (work.observer.forecast) work.observer.forecast(contest.forecast);
    return true;
  }
  // Until the pilots tell more: a pilot is like a repeat without its slopes, a reference like some twenty of them.
  const double one_repeat = contest.forecast.repeats / rounds / double(contestants.size());
  work.meter.expect(contest.forecast.repeats + one_repeat * (0.5 * double(contestants.size()) + 10));
  const std::vector<lab::Pilot> pilots =
      lab::run_pilots(contestants, state, seconds, work.settings, work.meter.watch());
  if (work.meter.watch().stopped()) return false;
  for (std::size_t i = 0; i < pilots.size(); ++i) seconds[i] = pilots[i].wall_seconds / pilots[i].samples;
  contest.forecast.pilots = work.meter.elapsed();
  contest.forecast.repeats = expect_repeats(work.field, work.settings, rounds, seconds, state);
  constexpr double wanted_share = 0.05;
  take_reference(work,
                 lab::plan_reference(pilots, source.may_serve, samples_of_repeats(state, work.settings, seconds),
                                     work.settings.measure, wanted_share),
                 contest);
  return !work.meter.watch().stopped();
}

// What is saved fits the scene as it is now.
Status check_fit(const SavedContest& saved, const Field& field, const PixelBounds& b) {
  if (saved.state.reference.mean.width != b.width() || saved.state.reference.mean.height != b.height() ||
      saved.state.methods.size() != field.contestants.size())
    return Failure{"the saved comparison does not fit the scene: it has other sizes"};
  for (std::size_t i = 0; i < field.contestants.size(); ++i) {
    const auto& layers = field.contestants[i].layers;
    const auto& shares = saved.state.methods[i].pixel_shares;
    if (!shares.empty() && (!layers || shares.size() != std::size_t(layers->count()) + 1))
      return Failure{"the saved comparison does not fit the scene: its variance was attributed to other layers"};
  }
  return Done{};
}

}  // namespace

Status check_methods(const ContestOptions& options) {
  if (auto methods = read_methods(options); !methods) return methods.failure();
  return Done{};
}

Result<Contest> compare_methods(const LoadedScene& scene, const ContestOptions& options,
                                const ContestObserver& observer) {
  ContestMeter meter(observer);
  auto field = make_field(scene.parts(), options);
  if (!field) return field.failure();
  if (Status warm = check_warm_up(field->contestants, options); !warm) return warm.failure();
  auto settings = settings_of(scene.parts(), options);
  if (!settings) return settings.failure();
  auto source = find_reference(options, field->contestants, settings->render.bounds);
  if (!source) return source.failure();
  Contest contest;
  contest.saved.options = options;
  const Work work{scene.parts(), *field, *settings, observer, meter};
  if (!prepare(work, *std::move(source), contest))
    return Failure{"interrupted before there was a reference to compare with"};
  const bool whole =
      lab::run_rounds(field->contestants, *settings, settings->repeats, meter.watch(), contest.saved.state);
  conclude(scene.parts(), *field, *settings, !whole, contest);
  contest.seconds = meter.elapsed();
  return contest;
}

Result<Contest> continue_contest(const LoadedScene& scene, SavedContest saved, const ContestBudget& more,
                                 const ContestObserver& observer) {
  ContestMeter meter(observer);
  auto field = make_field(scene.parts(), saved.options);
  if (!field) return field.failure();
  auto settings = settings_of(scene.parts(), saved.options);
  if (!settings) return settings.failure();
  if (Status fits = check_fit(saved, *field, settings->render.bounds); !fits) return fits.failure();
  int rounds = more.repeats.value_or(settings->repeats);
  if (more.seconds) {
    const std::optional<double> one = seconds_of_repeat(saved.state, *settings);
    if (!one)
      return Failure{
          "the saved comparison has no finished repeat, so its duration is unknown: use --repeats instead of --time"};
    rounds = int(std::clamp(std::round(*more.seconds / *one), 1.0, 1e6));
  }
  Contest contest;
  contest.saved = std::move(saved);
  const std::vector<double> seconds =
      lab::time_methods(field->contestants, contest.saved.state, *settings, meter.watch());
  contest.forecast.repeats = expect_repeats(*field, *settings, rounds, seconds, contest.saved.state);
  meter.expect(contest.forecast.repeats);
  if (observer.forecast) observer.forecast(contest.forecast);
  const bool whole = lab::run_rounds(field->contestants, *settings, rounds, meter.watch(), contest.saved.state);
  conclude(scene.parts(), *field, *settings, !whole, contest);
  contest.seconds = meter.elapsed();
  return contest;
}

}  // namespace montelux
