// Renders one image: within its time, or with its number of samples.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/film_keeper.h"
#include "api/render_plan.h"
#include "render/adaptive_plan.h"
#include "render/pass_shares.h"
#include "render/shared_samples.h"
#include "render/target_plan.h"
#include "render/timed_plan.h"

namespace montelux {

namespace {

// A frame of a series does not begin if it is expected to end later than the time by this share of it.
constexpr double max_lateness = 0.1;

// The time of an image, from the making of its integrator to its files.
class TimeOfImage {
 public:
  // `before`: the seconds that were used when `since` began.
  TimeOfImage(double all, double before, Stopwatch since, FinishTime finish)
      : all_(all), before_(before), since_(std::move(since)), finish_(finish) {}

  double used() const { return before_ + since_.seconds(); }
  // Seconds for rendering an image that samples one pixel of each stride x stride. The error of a sparse image is not
  // estimated.
  double left(int stride = 1) const { return left_until(all_ - encoding(stride) - (stride > 1 ? 0 : finish_.error)); }
  // Ends the render when no time is left.
  std::shared_ptr<TimeLimit> limit(int stride = 1) const {
    return std::make_shared<TimeLimit>(left(stride), true, max_lateness * all_);
  }

  void announce_if_late(int stride, RenderObserver& observer) const {
    if (left_until(all_ - encoding(stride)) > min_share * all_) return;
    observer.announce(fmt::format("preparing and writing the image takes about {:.2g} s in addition to the time",
                                  used() + encoding(stride)));
  }

 private:
  // The share of the time that is rendered in any case.
  static constexpr double min_share = 0.1;
  double left_until(double end) const { return std::max(end - used(), min_share * all_); }
  double encoding(int stride) const { return stride > 1 ? finish_.encoding_of(stride) : finish_.encoding; }

  double all_, before_;
  Stopwatch since_;
  FinishTime finish_;
};

// The passes of a render to an error, with at most so many samples per pixel, and the pilot that decided them.
struct PassesToTarget {
  PassPlan passes;
  std::optional<Pilot> pilot;
};
PassesToTarget plan_to_target(const RenderPlan& plan, const RenderSettings& settings, int max_samples,
                              RenderObserver& observer) {
  const TargetRequest& target = *plan.target;
  const std::optional<int> stated = plan.samples_per_pass;
  if (stated && !target.unbiased) return {{*stated, (max_samples + *stated - 1) / *stated}, {}};
  const auto plan_by_pilot = target.unbiased ? plan_in_two_stages : plan_for_target;
  PlanOfPilot planned = plan_by_pilot(plan.chosen.any(), settings, *settings.target, max_samples, observer);
  PassPlan passes = planned.plan;
  if (stated) passes = {*stated, (passes.samples() + *stated - 1) / *stated};
  return {passes, std::move(planned.pilot)};
}

// Whether the number of samples is decided by others than those of the image.
bool is_unbiased(const RenderPlan& plan) { return plan.target && plan.target->unbiased; }

// Small tiles, each of which has passes of its own. Where pixels share samples, those around a tile are traced for it
// alone, which takes more than small tiles gain.
void make_tiles_small(const RenderPlan& plan, RenderSettings& settings) {
  if (filters_share_samples(settings.image, plan.chosen.any())) return;
  PassPlan& passes = settings.plan;
  const int k = passes.samples_per_pass, side = std::min(adaptive_tile_side(k), passes.tile_side());
  passes.max_unit_samples = side * side * k;
}

// Gives tiles passes by a pilot. The number of samples that a target needs falls by the gain. `film`: to be saved, if
// there is one.
void make_adaptive(const RenderPlan& plan, RenderSettings& settings, const Pilot& pilot, SavedFilm* film) {
  make_tiles_small(plan, settings);
  const ImageFigures image = figures_of(pilot.film, pilot.rays, plan.target->error.measure, settings.plan.tile_side());
  const std::vector<double> shares = pass_shares(image, 0);
  int& passes = settings.plan.passes;
  passes = std::max(int(std::ceil(passes / std::max(expected_gain(image, shares), 1.0))),
                    std::min(passes, min_adaptive_passes));
  // Its passes would compare the tiles that have most of them.
  settings.unbiased = nullptr;
  settings.work = std::make_shared<AdaptivePlan>(shares, min_adaptive_passes, std::nullopt);
  if (film) film->adaptive = {min_adaptive_passes, shares};
}

// What is known of the passes before they are rendered.
void state_passes(const RenderPlan& plan, const RenderSettings& settings, SavedFilm& film) {
  film.settings.samples_per_pass = film.facts.samples_per_pass = settings.plan.samples_per_pass;
  if (is_unbiased(plan))
    film.wanted = PassRange{settings.plan.first_pass, settings.plan.first_pass + settings.plan.passes - 1};
}

// How an adaptive image begins or continues, where it has enough passes.
std::optional<AdaptiveFilm> adaptive_film(const RenderSettings& settings, std::optional<int> passes,
                                          RenderObserver& observer, const SavedFilm* film) {
  if (film && film->adaptive) return film->adaptive;
  constexpr int min_passes = 2 * min_adaptive_passes;
  const int known = passes.value_or(std::min(settings.plan.passes, min_passes));
  if (const std::optional<int> first = first_passes(known)) return AdaptiveFilm{*first, {}};
  observer.announce(fmt::format("the image is not adaptive: that takes at least {} passes, not {}", min_passes, known));
  return std::nullopt;
}

// Plans the passes of an adaptive image. Renders the first ones, which decide how many more each tile has, as far as a
// film that is continued lacks them. `passes`: of the image, as far as that is known; `film`: to be saved, if there is
// one. Returns the film to continue, if passes were rendered.
std::optional<BegunFilm> begin_adaptive(const RenderPlan& plan, RenderSettings& settings, std::optional<int> passes,
                                        RenderObserver& observer, SavedFilm* film) {
  std::optional<AdaptiveFilm> adaptive = adaptive_film(settings, passes, observer, film);
  if (!adaptive) return std::nullopt;
  make_tiles_small(plan, settings);
  settings.unbiased = nullptr;
  const bool looks = plan.target && !is_unbiased(plan);
  const std::optional<TargetJudge> target = looks ? settings.target : std::nullopt;
  const int first = adaptive->first_passes;
  std::optional<BegunFilm> begun;
  if (adaptive->shares.empty()) {
    if (film) film->adaptive = adaptive, state_passes(plan, settings, *film);
    RenderSettings of_first = settings;
    of_first.plan.passes = std::min(first, settings.plan.passes), of_first.target.reset(), of_first.work = nullptr;
    FirstPart part =
        render_first_part(plan.chosen.any(), of_first, target ? target->target().measure : TargetMeasure::relative,
                          passes ? double(first) / *passes : 0, observer);
    begun = std::move(part.begun);
    if (!part.is_complete || of_first.plan.passes < first) return begun;
    adaptive->shares = std::move(part.shares);
    if (film) film->adaptive = adaptive;
  }
  settings.work = std::make_shared<AdaptivePlan>(adaptive->shares, first, target);
  return begun;
}

// Plans the passes for the time that is left, and sets the rule that ends it. The time includes the making of the
// integrator, the measurement of its speed, and the writing of the image. `before` is the time used so far, and grows
// by what this takes. Returns the film to continue, if some of the image is rendered already.
std::optional<BegunFilm> plan_timed(const RenderPlan& plan, RenderSettings& settings, double& before,
                                    RenderObserver& observer, SavedFilm* film) {
  const Stopwatch since_start;
  const AnyIntegrator integrator = plan.chosen.any();
  const TimeOfImage time(
      *plan.seconds, before, since_start,
      seconds_to_finish(settings.image.bounds, plan.files,
                        {plan.denoise, plan.intervals, plan.denoises_sequence() ? SequenceDenoiser::max_earlier : 0,
                         settings.image.layers, plan.filter, settings.threads}));
  if (settings.begun) {
    time.announce_if_late(1, observer);
    settings.stop = time.limit();
    std::optional<BegunFilm> begun;
    const double seconds = settings.begun->seconds;
    if (plan.adaptive) begun = begin_adaptive(plan, settings, std::nullopt, observer, film);
    settings.stop = time.limit();
    before = time.used() - (begun ? begun->seconds - seconds : 0);
    return begun;
  }
  TimedPlan timed = plan_for_time(integrator, settings, time.left(), observer);
  if (plan.samples_per_pass) timed.plan.samples_per_pass = *plan.samples_per_pass;
  if (settings.keeping.keep && timed.plan.stride > 1) {
    observer.announce(
        fmt::format("one sample of every pixel takes about {:.2g} s, more than the time: a film that is "
                    "saved has one all the same",
                    timed.sample_seconds));
    timed.plan.stride = 1;
  }
  std::optional<Pilot> pilot;
  // Too few samples to spend some of them on a pilot.
  constexpr double min_samples = 64;
  const double affordable = time.left() / timed.sample_seconds;
  if (plan.target && timed.plan.stride == 1 && affordable >= min_samples) {
    const int max_samples = int(std::min(affordable, double(plan.max_samples)));
    PassesToTarget to_target = plan_to_target(plan, settings, max_samples, observer);
    const PassPlan& passes = to_target.passes;
    timed.plan.samples_per_pass = std::min(passes.samples_per_pass, timed.plan.samples_per_pass);
    if (plan.target->unbiased) timed.plan.passes = (passes.samples() - 1) / timed.plan.samples_per_pass + 1;
    pilot = std::move(to_target.pilot);
  }
  const double first_seconds = timed.plan.stride > 1 ? timed.first_seconds : timed.sample_seconds;
  settings.plan = timed.plan;
  const int stride = settings.plan.stride;
  time.announce_if_late(stride, observer);
  if (stride > 1)
    observer.announce(fmt::format("one sample per pixel takes about {:.2g} s, more than the time: {}",
                                  timed.sample_seconds, sparse_text(stride)));
  if (integrator.coupled() && first_seconds > (1 + max_lateness) * time.left(stride))
    observer.announce(
        fmt::format("the first frame takes about {:.2g} s, more than the time: the image is one frame", first_seconds));
  settings.stop = time.limit(stride);
  std::optional<BegunFilm> begun;
  if (plan.adaptive && stride == 1 && !is_unbiased(plan)) {
    const int passes = int(std::min(affordable, double(max_film_samples))) / settings.plan.samples_per_pass;
    begun = begin_adaptive(plan, settings, plan.target ? std::nullopt : std::optional(passes), observer, film);
  } else if (plan.adaptive && pilot) {
    make_adaptive(plan, settings, *pilot, film);
  }
  settings.stop = time.limit(stride);
  before = time.used() - (begun ? begun->seconds : 0);
  return begun;
}

}  // namespace

void add_denoised(Rendering& rendering, const std::function<Result<DenoisedLayers>(const Film&)>& denoise,
                  RenderObserver& observer) {
  if (rendering.found_no_light) return;
  Result<DenoisedLayers> layers = denoise(rendering.result.film);
  if (!layers) {
    observer.announce(layers.error());
    return;
  }
  rendering.denoised = *std::move(layers);
  const std::vector<Attribute> entries = header_of(rendering.denoised->estimate);
  rendering.header.insert(rendering.header.end(), entries.begin(), entries.end());
}

Rendering render_picture(const LoadedScene::Parts& parts, RenderPlan& plan, RenderSettings settings,
                         RenderObserver& observer, SavedFilm* film) {
  // The integrator is made once for all images of a sequence; the first one counts it.
  double before = std::exchange(plan.preparation, 0.0);
  std::optional<BegunFilm> begun;
  if (plan.seconds) begun = plan_timed(plan, settings, before, observer, film);
  if (plan.target && !plan.seconds && !settings.begun) {
    const Stopwatch since_start;
    PassesToTarget to_target = plan_to_target(plan, settings, plan.max_samples, observer);
    settings.plan = to_target.passes;
    if (plan.adaptive && is_unbiased(plan)) make_adaptive(plan, settings, *to_target.pilot, film);
    before += since_start.seconds();
  }
  if (plan.adaptive && !plan.seconds && (!is_unbiased(plan) || settings.begun))
    begun = begin_adaptive(plan, settings, plan.target ? std::nullopt : std::optional(settings.plan.passes), observer,
                           film);
  if (begun) settings.begun = &*begun;
  if (plan.budget) settings.stop = std::make_shared<TimeBudget>(*plan.budget - before, plan.ending);
  if (film) {
    state_passes(plan, settings, *film);
    film->begun.seconds = before;
  }
  if (!plan.adaptive && filters_share_samples(settings.image, plan.chosen.any()))
    widen_tiles(settings.image.bounds, settings.plan);
  RenderResult result = render(plan.chosen.any(), settings, observer);
  result.seconds += before;
  if (plan.budget) {
    const PixelBounds& b = settings.image.bounds;
    const int passes = std::max(result.film.image().passes, 1);
    settings.plan = {int(result.film.samples(b.x0, b.y0)) / passes, passes};
    plan.ending = result.ending;
  }
  Rendering rendering =
      rendering_of(facts_of(parts, plan, settings), std::move(result), settings.plan, settings.target);
  rendering.threads = settings.threads;
  if (plan.denoise && !plan.denoises_sequence()) {
    const auto without_noise = [&](const Film& of) -> Result<DenoisedLayers> {
      // A judge does not filter the layers of light.
      if (plan.judged && !rendering.layers)
        if (std::optional<DenoisedLayers> judged = plan.judged->take(of)) return *std::move(judged);
      return denoise(of, denoise_options(rendering.layers, settings.threads, plan.filter));
    };
    add_denoised(rendering, without_noise, observer);
  }
  if (plan.intervals && !add_intervals(rendering))
    observer.announce("the intervals of the pixels are unknown: it takes two independent passes, and light");
  return rendering;
}

}  // namespace montelux
